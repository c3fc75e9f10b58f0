/// A clerk whose tasks run when the test says so, and what rooms need beside it.
#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "server/journal/clerk.hpp"
#include "server/room/mesh_round.hpp"

namespace earthwork::room {

/// One thread only.
class ManualClerk final : public journal::Clerk {
 public:
  explicit ManualClerk(std::unique_ptr<journal::Journal> journal) : journal_(std::move(journal)) {}

  void post(journal::Urgency urgency, Task task) override {
    if (at_once) return task(*journal_);
    (urgency == journal::Urgency::now ? now_ : idle_).push_back(std::move(task));
  }
  /// Runs tasks, also those that they lead to, until none is left or `most` have run. Gives back
  /// how many ran.
  int run(int most = std::numeric_limits<int>::max()) {
    int ran = 0;
    for (; ran < most && waiting() > 0; ++ran) {
      std::deque<Task>& queue = now_.empty() ? idle_ : now_;
      const Task task = std::move(queue.front());
      queue.pop_front();
      task(*journal_);
    }
    return ran;
  }
  bool at_once = false;  ///< What is posted runs within the call.
  [[nodiscard]] std::size_t waiting() const { return now_.size() + idle_.size(); }
  [[nodiscard]] std::size_t waiting_idle() const { return idle_.size(); }
  [[nodiscard]] journal::Journal& journal() { return *journal_; }

 private:
  std::unique_ptr<journal::Journal> journal_;
  std::deque<Task> now_, idle_;
};

/// What comes back is done within the call.
inline Workplace back_at_once() {
  return {.aside = {}, .back = [](const Strand::Task& task) { task(); }};
}

}  // namespace earthwork::room
