#include "server/journal/clerk.hpp"

#include <cassert>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

namespace earthwork::journal {
namespace {

class ThreadClerk final : public Clerk {
 public:
  explicit ThreadClerk(std::unique_ptr<Journal> journal)
      : journal_(std::move(journal)), thread_([this] { work(); }) {}
  ~ThreadClerk() override {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  void post(Urgency urgency, Task task) override {
    {
      const std::lock_guard lock(mutex_);
      (urgency == Urgency::now ? now_ : idle_).push_back(std::move(task));
    }
    wake_.notify_one();
  }

 private:
  void work() noexcept {
    while (const Task task = next()) task(*journal_);
  }

  /// Waits for it; none when the clerk ends and all is done.
  Task next() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return ending_ || !now_.empty() || !idle_.empty(); });
    std::deque<Task>& queue = now_.empty() ? idle_ : now_;
    if (queue.empty()) return nullptr;
    Task task = std::move(queue.front());
    queue.pop_front();
    return task;
  }

  std::unique_ptr<Journal> journal_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> now_, idle_;
  bool ending_ = false;
  std::thread thread_;  // last: it uses all of the above
};

class ImmediateClerk final : public Clerk {
 public:
  explicit ImmediateClerk(std::unique_ptr<Journal> journal) : journal_(std::move(journal)) {}

  void post(Urgency, Task task) override {
    assert(!working_);
    working_ = true;
    task(*journal_);
    working_ = false;
  }

 private:
  std::unique_ptr<Journal> journal_;
  bool working_ = false;
};

}  // namespace

std::unique_ptr<Clerk> hire_clerk(std::unique_ptr<Journal> journal) {
  return std::make_unique<ThreadClerk>(std::move(journal));
}

std::unique_ptr<Clerk> immediate_clerk(std::unique_ptr<Journal> journal) {
  return std::make_unique<ImmediateClerk>(std::move(journal));
}

}  // namespace earthwork::journal
