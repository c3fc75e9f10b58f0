/// Tasks that take long - a map to be read, a journal to be closed - a few at a time, however many
/// wait.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "server/room/strand.hpp"

namespace earthwork::room {

/// Any thread. Held by shared_ptr: what waits or runs keeps it alive.
class AsideQueue : public std::enable_shared_from_this<AsideQueue> {
 public:
  /// `run` runs a task where it holds nobody up, or within the call; each once. It is never given
  /// more than `most` that have not ended.
  AsideQueue(std::function<void(Strand::Task)> run, int most);

  /// Runs the task when its turn comes, in order: perhaps within the call. What it throws goes on
  /// to whoever runs it, and has ended that task alone.
  void post(Strand::Task task);

 private:
  void start_what_may();
  void ended();

  const std::function<void(Strand::Task)> run_;
  const int most_;
  std::mutex mutex_;
  std::deque<Strand::Task> waiting_;
  int running_ = 0;
};

}  // namespace earthwork::room
