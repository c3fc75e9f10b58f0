/// When to tell the others where one points: as it changes, but not too often, and now and then
/// when it does not, for a server forgets who is silent.
#pragma once

#include <chrono>
#include <optional>

#include "protocol/messages.hpp"

namespace earthwork::viewer {

inline constexpr std::chrono::milliseconds kCursorEvery{50};
inline constexpr std::chrono::seconds kCursorAgain{20};

class CursorTeller {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The cursor is this; true when it is to be said now.
  [[nodiscard]] bool tell(const protocol::Cursor& cursor, Time now);
  /// When to ask again, if nothing changes.
  [[nodiscard]] std::optional<Time> due() const { return due_; }
  /// Nobody was told yet: there is another connection.
  void forget();

 private:
  std::optional<protocol::Cursor> said_;
  Time said_at_{};
  std::optional<Time> due_;
};

/// What is said of a pointer at `at`, or nowhere, with this brush, by who sees `view`. Where the
/// brush could not be stamped there is no cursor.
[[nodiscard]] protocol::Cursor cursor_of(std::optional<protocol::MapPoint> at,
                                         const std::optional<protocol::Brush>& brush,
                                         const protocol::MapRect& view,
                                         const protocol::MapSettings& settings);

}  // namespace earthwork::viewer
