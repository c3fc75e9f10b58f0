#include "server/room/herald.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::room {
namespace {

using std::chrono::milliseconds;

// A viewer is told of people at most ten times a second.
constexpr milliseconds kTick{100};

}  // namespace

Herald::Herald(PastEvents& events, const Strand& clock, Later later)
    : events_(events), clock_(clock), later_(std::move(later)) {
  events_.when_page_comes([this] { tell_events(); });
}

void Herald::enter(ViewerId id, Viewer& viewer, protocol::User user) {
  listeners_[id].viewer = &viewer;
  board_.enter(id, std::move(user));
  people_changed();
}

void Herald::leave(ViewerId id) {
  listeners_.erase(id);
  feed_.leave(id);
  if (feed_.empty()) events_.forget_pages();
  board_.leave(id);
  people_changed();
}

void Herald::leave_all() {
  listeners_.clear();
  feed_ = {};
  events_.forget_pages();
  board_ = {};
}

void Herald::point(ViewerId id, const protocol::Cursor& cursor) {
  board_.point(id, cursor, clock_.now_ms());
  if (cursor.at && !hiding_) hide_cursors_after(milliseconds(kCursorMs));
  people_changed();
}

void Herald::follow(ViewerId id, std::uint64_t from_seq) {
  if (!listeners_.contains(id)) return;
  feed_.follow(id, from_seq);
  later_(milliseconds{0}, [this, id] {
    if (const auto found = listeners_.find(id); found != listeners_.end())
      talk_to(id, found->second);
  });
}

void Herald::heard(ViewerId id) {
  const auto found = listeners_.find(id);
  if (found == listeners_.end()) return;
  found->second.hears = true;
  talk_to(id, found->second);
}

void Herald::tell_events() {
  for (const ViewerId id : feed_.followers()) talk_to(id, listeners_.at(id));
  if (feed_.empty()) events_.forget_pages();
}

void Herald::talk_to(ViewerId id, Listener& listener) {
  if (!listener.hears) return;
  Talk talk;
  std::size_t bytes = kMaxTalkBytes;
  if (SharedText news = board_.news_for(id)) {
    bytes -= std::min(bytes, news->size());
    talk.messages.push_back(std::move(news));
  }
  feed_.tell(id, events_, bytes, talk.messages);
  if (talk.messages.empty()) return;
  listener.hears = false;
  listener.viewer->tell(std::move(talk));
}

// The first change is told at once, what follows it together at the next tick: so a crowd that
// comes in is written for a few times and not once for each.
void Herald::people_changed() {
  if (ticking_ || !board_.changed()) return;
  ticking_ = true;
  later_(milliseconds{0}, [this] { tick(); });
}

void Herald::tick() {
  ticking_ = board_.changed();
  if (!ticking_) return;
  board_.advance();
  for (auto& [id, listener] : listeners_) talk_to(id, listener);
  later_(kTick, [this] { tick(); });
}

void Herald::hide_cursors_after(milliseconds delay) {
  hiding_ = true;
  later_(delay, [this] {
    hiding_ = false;
    const std::int64_t now_ms = clock_.now_ms();
    // A clock that was set back must not make it wait for long.
    if (const auto next_ms = board_.hide_old(now_ms))
      hide_cursors_after(milliseconds(std::clamp(*next_ms - now_ms, std::int64_t{1}, kCursorMs)));
    people_changed();
  });
}

}  // namespace earthwork::room
