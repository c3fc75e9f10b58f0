#include "server/room/herald.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::room {
namespace {

using std::chrono::milliseconds;

// A viewer is told of people, and what they say, at most ten times a second.
constexpr milliseconds kTick{100};

}  // namespace

Herald::Herald(PastEvents& events, const Strand& clock, std::shared_ptr<ChatLog> chat, Later later)
    : events_(events), clock_(clock), later_(std::move(later)), chat_(std::move(chat)) {
  events_.when_page_comes([this] { tell_events(); });
}

void Herald::enter(ViewerId id, Viewer& viewer, protocol::User user) {
  listeners_[id].viewer = &viewer;
  board_.enter(id, std::move(user));
  chat_.enter(id);
  // What was said comes right away, ahead of the meshes that it will ask for; the next tick, which
  // tells of its coming, tells the others what of it they do not know.
  if (chat_.changed()) chat_.advance();
  if (chat_.owes(id)) talk_soon(id);
  tell_soon();
}

void Herald::leave(ViewerId id) {
  listeners_.erase(id);
  feed_.leave(id);
  if (feed_.empty()) events_.forget_pages();
  board_.leave(id);
  chat_.leave(id);
  tell_soon();
}

void Herald::leave_all() {
  listeners_.clear();
  feed_ = {};
  events_.forget_pages();
  board_ = {};
  chat_.leave_all();
}

void Herald::point(ViewerId id, const protocol::Cursor& cursor) {
  board_.point(id, cursor, clock_.now_ms());
  if (cursor.at && !hiding_) hide_cursors_after(milliseconds(kCursorMs));
  tell_soon();
}

void Herald::say(ViewerId id, std::string text) {
  const protocol::User* speaker = board_.user_of(id);
  if (speaker == nullptr) return;
  chat_.add({.time_ms = clock_.now_ms(),
             .session = speaker->session,
             .name = speaker->name,
             .color = speaker->color,
             .text = std::move(text)});
  tell_soon();
}

void Herald::follow(ViewerId id, std::uint64_t from_seq) {
  if (!listeners_.contains(id)) return;
  feed_.follow(id, from_seq);
  talk_soon(id);
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

void Herald::talk_soon(ViewerId id) {
  later_(milliseconds{0}, [this, id] {
    if (const auto found = listeners_.find(id); found != listeners_.end())
      talk_to(id, found->second);
  });
}

void Herald::talk_to(ViewerId id, Listener& listener) {
  if (!listener.hears) return;
  Talk talk;
  std::size_t bytes = kMaxTalkBytes;
  for (SharedText news : {chat_.news_for(id), board_.news_for(id)}) {
    if (!news) continue;
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
void Herald::tell_soon() {
  if (ticking_ || !(board_.changed() || chat_.changed())) return;
  ticking_ = true;
  later_(milliseconds{0}, [this] { tick(); });
}

void Herald::tick() {
  ticking_ = board_.changed() || chat_.changed();
  if (!ticking_) return;
  if (board_.changed()) board_.advance();
  if (chat_.changed()) chat_.advance();
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
    tell_soon();
  });
}

}  // namespace earthwork::room
