/// Tells the viewers of a map about people, what they say, and events: to each one talk at a time,
/// and what is new once it was heard.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "server/history/event.hpp"
#include "server/room/chat_feed.hpp"
#include "server/room/event_feed.hpp"
#include "server/room/presence_board.hpp"
#include "server/room/strand.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// On the strand of the room whose part it is. It runs a timer only for a tenth of a second after
/// people changed or said something, and while there are cursors to hide.
class Herald {
 public:
  /// Runs a task on that strand after a delay, or not at all when the room is gone by then.
  using Later = std::function<void(std::chrono::milliseconds delay, std::function<void()> task)>;

  /// Is called when a page of `events` comes. They and `clock` outlive the herald; what is said is
  /// kept in `chat`.
  Herald(PastEvents& events, const Strand& clock, std::shared_ptr<ChatLog> chat, Later later);

  /// `viewer` stays until it leaves. Its user is told to the others soon, and it is told what was
  /// said before.
  void enter(ViewerId id, Viewer& viewer, protocol::User user);
  /// After it the viewer is not called again, and is nobody here.
  void leave(ViewerId id);
  void leave_all();
  /// Who is there, for who has just entered: up to kMaxJoinedUsers, itself the last.
  [[nodiscard]] std::vector<protocol::User> users_for(ViewerId id) const {
    return board_.users_for(id);
  }

  /// None of these calls a viewer, apart from `heard`, and none does anything for nobody.
  void point(ViewerId id, const protocol::Cursor& cursor);
  /// To all, itself too; at most ten times a second, what is said meanwhile together.
  void say(ViewerId id, std::string text);
  /// From `from_seq` on, at least 1 and at most the one after `events.last_seq()`.
  void follow(ViewerId id, std::uint64_t from_seq);
  /// The viewer takes the next talk: from within the call, if there is one.
  void heard(ViewerId id);

  /// There may be new events, or a page of past ones: tells them to the viewers that follow and
  /// hear.
  void tell_events();

 private:
  struct Listener {
    Viewer* viewer = nullptr;
    bool hears = true;  // the last talk was heard
  };

  void talk_to(ViewerId id, Listener& listener);
  void talk_soon(ViewerId id);
  void tell_soon();
  void tick();
  void hide_cursors_after(std::chrono::milliseconds delay);

  PastEvents& events_;
  const Strand& clock_;
  const Later later_;
  PresenceBoard board_;
  ChatFeed chat_;
  EventFeed feed_;
  std::map<ViewerId, Listener> listeners_;
  bool ticking_ = false, hiding_ = false;  // a timer runs
};

}  // namespace earthwork::room
