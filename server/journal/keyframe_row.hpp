/// A row of the table keyframes: the keyframe, and what tells whether all of it is there.
#pragma once

#include <cstdint>

#include "server/journal/database.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

struct KeyframeRow {
  Keyframe keyframe;
  std::uint64_t chunks = 0;   ///< That have a state up to its seq, blank ones too.
  std::uint64_t digest = 0;   ///< The sums of the newest of these states, XORed.
  std::uint64_t authors = 0;  ///< That there are at least.
};

/// Fails with bad_state when there is none.
[[nodiscard]] protocol::Result<KeyframeRow> find_keyframe(Database& database, std::uint64_t seq);

/// Adds to the counts of keyframe `since`, or to none, what the chunk rows after it make of them.
[[nodiscard]] protocol::Result<void> count_chunks(Database& database, std::uint64_t since,
                                                  KeyframeRow& row);

}  // namespace earthwork::journal
