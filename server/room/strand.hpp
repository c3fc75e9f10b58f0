/// Where a room's work runs: one task at a time, in the order in which it was posted. The one
/// thing of threads and clocks that a room sees.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

namespace earthwork::room {

/// Any thread may post. A task that was posted runs once, unless the strand's thread pool ends
/// first. What a task throws ends that task alone: a running server logs it.
class Strand {
 public:
  using Task = std::function<void()>;

  virtual ~Strand() = default;
  virtual void post(Task task) = 0;
  /// Runs a task beside the strand, on the threads that it shares with others, in no order.
  virtual void post_aside(Task task) = 0;
  virtual void post_after(std::chrono::milliseconds delay, Task task) = 0;
  /// Milliseconds since 1970, UTC.
  [[nodiscard]] virtual std::int64_t now_ms() const = 0;
};

}  // namespace earthwork::room
