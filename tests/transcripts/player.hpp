// Plays a transcript against a server of its own.
#pragma once

#include <chrono>
#include <string>

#include "tests/transcripts/transcript.hpp"

namespace earthwork::transcripts {

/// Starts earthwork-server and gives back an empty text when every client received exactly the
/// lines of the transcript, or else what differs. What else they receive is noticed when it begins
/// within `epilogue` after the last line.
std::string play(const Transcript& transcript,
                 std::chrono::nanoseconds epilogue = std::chrono::milliseconds(20));

/// The transcript with what the clients receive now.
Transcript record(const Transcript& transcript);

}  // namespace earthwork::transcripts
