/// A recording: everything that a map accepted, as JSON lines. Its first line is a map's settings,
/// every other one an event, so it is an edit script too (protocol/README.md: "Recordings").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "protocol/action.hpp"
#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

struct RecordingHead {
  MapSettings settings;
  std::optional<std::uint64_t> epoch;  ///< Of the map that was recorded.
  friend bool operator==(const RecordingHead&, const RecordingHead&) = default;
};

/// What an `event` message has, and the id that its author gave it.
struct RecordedEvent {
  std::uint64_t seq = 0;     ///< From 1 on.
  std::int64_t time_ms = 0;  ///< Since 1970, UTC.
  std::uint64_t author = 0;
  MessageId id = 0;
  Action action;
  std::uint64_t hash = 0;  ///< Of the map after it.
  friend bool operator==(const RecordedEvent&, const RecordedEvent&) = default;
};

/// One line, with or without its line break, of at most kMaxControlBytes. Everything is there, of
/// its type, in its range and finite; unknown keys are ignored. What needs the map or the lines
/// before - limits of edits, seqs without a gap, ids that increase - is the reader's to check.
[[nodiscard]] Result<RecordingHead> read_recording_head(std::string_view line);
[[nodiscard]] Result<RecordedEvent> read_recorded_event(std::string_view line);

/// The line's text, without a line break: the same for equal values.
[[nodiscard]] std::string write(const RecordingHead& head);
[[nodiscard]] std::string write(const RecordedEvent& event);

}  // namespace earthwork::protocol
