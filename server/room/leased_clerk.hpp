/// A clerk that is lent to a room: who lent it can end that, and learns when it has ended, whoever
/// else still holds the room.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "server/journal/clerk.hpp"

namespace earthwork::room {

/// Any thread.
class Lease {
 public:
  using GiveBack = std::function<void(std::unique_ptr<journal::Clerk>)>;

  Lease(std::unique_ptr<journal::Clerk> clerk, GiveBack give_back)
      : clerk_(std::move(clerk)), give_back_(std::move(give_back)) {}

  void post(journal::Urgency urgency, journal::Clerk::Task task) {
    const std::lock_guard lock(mutex_);
    if (clerk_) clerk_->post(urgency, std::move(task));
  }
  /// Gives the clerk back, the first time. It does what it was given before; what is posted from
  /// now on is dropped.
  void end() {
    std::unique_ptr<journal::Clerk> clerk;
    {
      const std::lock_guard lock(mutex_);
      clerk = std::move(clerk_);
    }
    if (clerk) give_back_(std::move(clerk));
  }

 private:
  std::mutex mutex_;
  std::unique_ptr<journal::Clerk> clerk_;
  const GiveBack give_back_;
};

/// The room's side. Its end only gives the clerk back, so it may come on a strand, or on the
/// clerk's own thread.
class LeasedClerk final : public journal::Clerk {
 public:
  explicit LeasedClerk(std::shared_ptr<Lease> lease) : lease_(std::move(lease)) {}
  ~LeasedClerk() override { lease_->end(); }
  LeasedClerk(const LeasedClerk&) = delete;
  LeasedClerk& operator=(const LeasedClerk&) = delete;

  void post(journal::Urgency urgency, Task task) override {
    lease_->post(urgency, std::move(task));
  }

 private:
  const std::shared_ptr<Lease> lease_;
};

}  // namespace earthwork::room
