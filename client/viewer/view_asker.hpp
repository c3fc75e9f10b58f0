/// Which part of a map to ask the server for: what is seen and somewhat more, so that a small move
/// asks for nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "protocol/chunk_range.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

/// Of two views that are asked for, apart from the first.
inline constexpr std::chrono::milliseconds kViewEvery{250};

class ViewAsker {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The view to ask for now, under the next number; none while the last one serves, or came less
  /// than kViewEvery before. It serves as long as it holds `seen` and is not much larger. A view
  /// covers at most kMaxViewChunks chunks of the map: of a larger part the middle, around `target`.
  [[nodiscard]] std::optional<protocol::View> ask(const protocol::MapRect& seen,
                                                  protocol::MapPoint target,
                                                  const protocol::MapSettings& settings, Time now);
  /// When to ask again, if that was too early.
  [[nodiscard]] std::optional<Time> due() const { return due_; }
  /// The number of the last view; 0 before the first.
  [[nodiscard]] std::uint32_t last() const { return n_; }
  [[nodiscard]] const protocol::MapRect& rect() const { return rect_; }
  /// Another map: no view serves.
  void forget();

 private:
  std::uint32_t n_ = 0;
  protocol::MapRect rect_;                     // of the last view
  std::optional<protocol::ChunkRange> asked_;  // its chunks
  Time asked_at_{};
  std::optional<Time> due_;
};

}  // namespace earthwork::viewer
