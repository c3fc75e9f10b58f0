/// How fast pictures are drawn.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>

namespace earthwork::viewer {

class Meter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A picture with so many triangles was done.
  void drawn(Time ended, std::size_t triangles);
  /// Pictures done in the last second.
  [[nodiscard]] double fps(Time now) const;
  /// Of the last picture.
  [[nodiscard]] std::size_t triangles() const { return triangles_; }

 private:
  std::deque<Time> ends_;  // of the last second, no more than kMost
  std::size_t triangles_ = 0;
};

}  // namespace earthwork::viewer
