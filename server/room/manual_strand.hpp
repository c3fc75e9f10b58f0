/// A strand without threads: tasks run when its owner says so, and time passes when told.
#pragma once

#include <deque>
#include <map>

#include "server/room/strand.hpp"

namespace earthwork::room {

/// One thread only.
class ManualStrand final : public Strand {
 public:
  void post(Task task) override { tasks_.push_back(std::move(task)); }
  void post_after(std::chrono::milliseconds delay, Task task) override;
  [[nodiscard]] std::int64_t now_ms() const override { return now_.count(); }

  /// Runs tasks, also those that they post, until none is left. Gives back how many ran.
  int run();
  /// Lets time pass, and runs what falls due meanwhile.
  void advance(std::chrono::milliseconds time);

 private:
  std::deque<Task> tasks_;
  std::multimap<std::chrono::milliseconds, Task> later_;  // by when they fall due
  std::chrono::milliseconds now_{0};
};

}  // namespace earthwork::room
