#include "server/room/guarded_viewer.hpp"

#include <utility>

namespace earthwork::room {

void GuardedViewer::guard(const std::function<void()>& call) {
  if (broken_) return;
  try {
    call();
    return;
  } catch (...) {
    broken_ = true;
  }
  try {
    viewer_->end({.failure = {protocol::Code::internal, "the server made a mistake", {}},
                  .retry_after_ms = {}});
  } catch (...) {  // it is past all help, and nobody else is to notice
  }
  broke_();
}

void GuardedViewer::answered(std::vector<Reply> replies) {
  guard([&] { viewer_->answered(std::move(replies)); });
}

void GuardedViewer::deliver(Parcel parcel) {
  guard([&] { viewer_->deliver(std::move(parcel)); });
}

void GuardedViewer::tell(Talk talk) {
  guard([&] { viewer_->tell(std::move(talk)); });
}

void GuardedViewer::settings(SharedText message) {
  guard([&] { viewer_->settings(std::move(message)); });
}

void GuardedViewer::end(protocol::Bye bye) {
  guard([&] { viewer_->end(std::move(bye)); });
}

}  // namespace earthwork::room
