#include "server/room/aside_queue.hpp"

#include <utility>

namespace earthwork::room {

AsideQueue::AsideQueue(std::function<void(Strand::Task)> run, int most)
    : run_(std::move(run)), most_(most) {}

void AsideQueue::post(Strand::Task task) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(task));
  }
  start_what_may();
}

void AsideQueue::start_what_may() {
  for (;;) {
    Strand::Task next;
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.empty() || running_ >= most_) return;
      ++running_;
      next = std::move(waiting_.front());
      waiting_.pop_front();
    }
    run_([self = shared_from_this(), task = std::move(next)] {
      try {
        task();
      } catch (...) {
        self->ended();
        throw;
      }
      self->ended();
    });
  }
}

void AsideQueue::ended() {
  {
    const std::lock_guard lock(mutex_);
    --running_;
  }
  start_what_may();
}

}  // namespace earthwork::room
