#include "server/room/manual_strand.hpp"

#include <utility>

namespace earthwork::room {

void ManualStrand::post_after(std::chrono::milliseconds delay, Task task) {
  later_.emplace(now_ + delay, std::move(task));
}

int ManualStrand::run() {
  int ran = 0;
  for (; !tasks_.empty(); ++ran) {
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    task();
  }
  return ran;
}

void ManualStrand::advance(std::chrono::milliseconds time) {
  const auto end = now_ + time;
  run();
  while (!later_.empty() && later_.begin()->first <= end) {
    now_ = later_.begin()->first;
    tasks_.push_back(std::move(later_.begin()->second));
    later_.erase(later_.begin());
    run();
  }
  now_ = end;
}

}  // namespace earthwork::room
