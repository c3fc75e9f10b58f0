/// A viewer whose mistakes are its own: what it throws stops at this wrapper, so that nothing of
/// it reaches the room or the other viewers.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "server/room/viewer.hpp"

namespace earthwork::room {

/// As thread-bound as Viewer.
class GuardedViewer final : public Viewer {
 public:
  /// `broke` is called once, when the viewer has thrown for the first time, and must not throw
  /// itself or call the viewer.
  GuardedViewer(std::shared_ptr<Viewer> viewer, std::function<void()> broke)
      : viewer_(std::move(viewer)), broke_(std::move(broke)) {}

  void answered(std::vector<Reply> replies) override;
  void deliver(Parcel parcel) override;
  void tell(Talk talk) override;
  void settings(SharedText message) override;
  void end(protocol::Bye bye) override;

  /// Calls something of the viewer's, unless it is broken.
  void guard(const std::function<void()>& call);

  /// It has thrown, was told to `end`, and is not called any more.
  [[nodiscard]] bool broken() const { return broken_; }

 private:
  const std::shared_ptr<Viewer> viewer_;
  const std::function<void()> broke_;
  bool broken_ = false;
};

}  // namespace earthwork::room
