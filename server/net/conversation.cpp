#include "server/net/conversation.hpp"

#include <string>
#include <utility>
#include <variant>

#include "protocol/limits.hpp"
#include "server/net/identity.hpp"
#include "server/room/entropy.hpp"

namespace earthwork::net {

using protocol::Code;
using protocol::Failure;
using protocol::MessageId;

namespace {

using RoomPointer = std::shared_ptr<room::Room>;

// A server that is ended on purpose is usually started again at once.
constexpr std::uint32_t kRestartMs = 1000;
// How often a map that is put away at the same moment is asked for.
constexpr int kMaxJoinTries = 3;

}  // namespace

Conversation::Conversation(room::Atlas& atlas, std::unique_ptr<room::Strand> own,
                           std::function<void()> wake)
    : atlas_(atlas), own_(std::move(own)), wake_(std::move(wake)) {}

void Conversation::receive(std::string_view text) {
  if (ending_) return;
  auto message = protocol::parse_client_message(text);
  if (!message) return reject(protocol::salvage_id(text), std::move(message.error()));
  if (!greeted() && !std::holds_alternative<protocol::Hello>(*message)) {
    const auto id = std::visit([](auto& m) { return std::optional<MessageId>(m.id); }, *message);
    return reject(id, {Code::bad_state, "say hello first", "type"});
  }
  std::visit([this](auto& m) { handle(m); }, *message);
}

void Conversation::refuse_binary() {
  reject({}, {Code::bad_message, "a client's messages are text; this one was binary", {}});
}

bool Conversation::may_read() const {
  const bool between = place_ == Place::entering || place_ == Place::leaving;
  // What a room that was left had already sent must be through before the next one sends.
  const bool stranded = place_ == Place::outside && (outbox_.has_parcel() || outbox_.has_talk());
  return !between && !stranded && unanswered_ < kMaxUnanswered &&
         outbox_.control_bytes() < kMaxControlWaiting;
}

void Conversation::handle(protocol::Hello& hello) {
  if (greeted()) return reject(hello.id, {Code::bad_state, "hello was said already", "type"});
  constexpr int kVersion = protocol::Hello::kMaxProtocol;
  if (hello.protocol_min > kVersion || hello.protocol_max < protocol::Hello::kMinProtocol) {
    Failure why{Code::bad_version,
                "protocol: this server speaks " + std::to_string(kVersion) + " only", "protocol"};
    if (hello.id) reject(hello.id, why);
    return say_bye(std::move(why));
  }
  user_.session = protocol::hex(room::random_u64());
  user_.name = std::move(hello.name);
  user_.color = hello.color ? *hello.color : color_for(user_.session);
  const std::string key = hello.key ? *hello.key : room::random_key();
  author_ = author_of(key);
  user_.author = protocol::hex(author_);
  say(protocol::Welcome{
      .session = user_.session, .key = key, .protocol = kVersion, .id = hello.id});
}

void Conversation::handle(protocol::Join& join) {
  if (place_ == Place::inside)
    return reject(join.id, {Code::bad_state, "leave " + room_->name() + " first", "type"});
  if (join.seq) return refuse_unsupported(join.id, "join with seq");
  place_ = Place::entering;
  enter({join.map, user_, join.id, kMaxJoinTries});
}

void Conversation::enter(Wish wish) {
  auto opened = [self = shared_from_this(), wish](const protocol::Result<RoomPointer>& room) {
    if (!room) return self->come_back({}, tl::unexpected<Failure>(room.error()), wish.id);
    self->run_in(*room, [self, wish, room = *room](room::Room&) {
      auto entrance = room->join(self, wish.user);
      if (!entrance) self->atlas_.let_go(*room);
      if (!entrance && wish.tries > 1)
        return self->enter({wish.map, wish.user, wish.id, wish.tries - 1});
      self->come_back(room, std::move(entrance), wish.id);
    });
  };
  atlas_.open(wish.map, room::Atlas::Errand::visit, std::move(opened));
}

void Conversation::come_back(const RoomPointer& room,
                             protocol::Result<room::Room::Entrance> entrance,
                             std::optional<MessageId> id) {
  own_->post([self = shared_from_this(), room, entrance = std::move(entrance), id] {
    self->entered(room, entrance, id);
  });
}

void Conversation::entered(const std::shared_ptr<room::Room>& room,
                           protocol::Result<room::Room::Entrance> entrance,
                           std::optional<MessageId> id) {
  if (!entrance) {
    place_ = Place::outside;
    return reject(id, std::move(entrance.error()));
  }
  place_ = Place::inside;
  room_ = room;
  viewer_ = entrance->viewer;
  if (abandoned_) return abandon();
  entrance->joined.id = id;
  say(entrance->joined);
}

void Conversation::handle(const protocol::Leave& leave) {
  if (place_ != Place::inside)
    return reject(leave.id, {Code::bad_state, "no map was joined", "type"});
  place_ = Place::leaving;
  in_room([self = shared_from_this(), id = leave.id](room::Room& room, room::ViewerId viewer) {
    // All that the room had told before is on the strand already, ahead of this.
    room.leave_when_told(viewer, [self, id] {
      self->own_->post([self, id] {
        self->place_ = Place::outside;
        self->room_.reset();
        self->outbox_.forget_settings();
        self->done(id);
      });
    });
  });
}

void Conversation::handle(protocol::View& view) {
  if (place_ != Place::inside)
    return reject(view.id, {Code::bad_state, "join a map first", "type"});
  const auto id = view.id;
  ask_room(id, [view = std::move(view)](room::Room& room, room::ViewerId viewer) {
    return room.look(viewer, view);
  });
}

void Conversation::handle(const protocol::Events& events) {
  if (place_ != Place::inside)
    return reject(events.id, {Code::bad_state, "join a map first", "type"});
  ask_room(events.id, [seq = events.from_seq](room::Room& room, room::ViewerId viewer) {
    return room.follow(viewer, seq);
  });
}

void Conversation::handle(protocol::Chat& chat) {
  if (place_ != Place::inside)
    return reject(chat.id, {Code::bad_state, "join a map first", "type"});
  if (const auto wait_ms = chat_rate_.take(own_->now_ms()))
    return reject(chat.id, {Code::too_fast,
                            "text: a session may say " + std::to_string(protocol::kMaxChatLines) +
                                " lines in " + std::to_string(protocol::kChatSeconds) +
                                " s; say it again in " + std::to_string(*wait_ms) + " ms",
                            "text"});
  ask_room(chat.id, [text = std::move(chat.text)](room::Room& room, room::ViewerId viewer) {
    return room.say(viewer, text);
  });
}

/// Of cursors without an id only the latest one waits while another is on its way to the room. One
/// with an id owes a reply and is sent on, so it is bounded as all that owe one.
void Conversation::handle(protocol::Cursor& cursor) {
  if (place_ != Place::inside)
    return reject(cursor.id, {Code::bad_state, "join a map first", "type"});
  next_cursor_.reset();
  if (cursor.id) {
    ++unanswered_;
    point(std::move(cursor));
  } else if (cursors_on_their_way_ == 0) {
    point(std::move(cursor));
  } else {
    next_cursor_ = std::move(cursor);
  }
}

void Conversation::point(protocol::Cursor cursor) {
  ++cursors_on_their_way_;
  in_room([self = shared_from_this(), cursor = std::move(cursor)](room::Room& room,
                                                                  room::ViewerId viewer) {
    self->own_->post(
        [self, id = cursor.id, result = room.point(viewer, cursor)] { self->pointed(id, result); });
  });
}

void Conversation::pointed(std::optional<MessageId> id, const protocol::Result<void>& result) {
  --cursors_on_their_way_;
  if (id)
    answered(id, result);
  else if (!result)
    reject(id, result.error());
  if (place_ != Place::inside) next_cursor_.reset();
  if (cursors_on_their_way_ == 0 && next_cursor_) point(*std::exchange(next_cursor_, std::nullopt));
}

void Conversation::submit(MessageId id, protocol::Action action) {
  if (place_ != Place::inside) return reject(id, {Code::bad_state, "join a map first", "type"});
  ++unanswered_;
  in_room([self = shared_from_this(), id,
           command = room::Room::Command{.id = id, .author = author_, .action = std::move(action)}](
              room::Room& room, room::ViewerId viewer) mutable {
    auto result = room.submit(viewer, std::move(command));
    if (!result) self->own_->post([self, id, result] { self->answered(id, result); });
  });
}

void Conversation::answered(std::optional<MessageId> id, const protocol::Result<void>& result) {
  --unanswered_;
  if (result)
    done(id);
  else
    reject(id, result.error());
}

void Conversation::handle(const protocol::Ping& ping) { done(ping.id); }

template <class Ask>
void Conversation::ask_room(std::optional<MessageId> id, Ask ask) {
  ++unanswered_;
  in_room([self = shared_from_this(), id, ask = std::move(ask)](room::Room& room,
                                                                room::ViewerId viewer) {
    self->own_->post([self, id, result = ask(room, viewer)] { self->answered(id, result); });
  });
}

template <class Task>
void Conversation::in_room(Task task) {
  run_in(room_, [viewer = viewer_, run = std::move(task)](room::Room& room) mutable {
    run(room, viewer);
  });
}

// A task that fails has lost a reply: then the session ends, so that its client need not wait.
template <class Task>
void Conversation::run_in(std::shared_ptr<room::Room> room, Task task) {
  room::Room& there = *room;
  there.strand().post(
      [self = shared_from_this(), room = std::move(room), run = std::move(task)]() mutable {
        try {
          run(*room);
        } catch (...) {
          self->own_->post([self] {
            self->say_bye({Code::internal, "the server made a mistake", {}});
          });
          throw;
        }
      });
}

void Conversation::take_output(std::string& out, std::size_t enough) {
  OutboxCounts counts;
  outbox_.take(out, enough, counts);
  room::Meters& meters = atlas_.meters();
  if (counts.frames > 0) {
    meters.frames.fetch_add(counts.frames, std::memory_order_relaxed);
    meters.frame_bytes.fetch_add(counts.frame_bytes, std::memory_order_relaxed);
  }
  if (counts.controls > 0) {
    meters.controls.fetch_add(counts.controls, std::memory_order_relaxed);
    meters.control_bytes.fetch_add(counts.control_bytes, std::memory_order_relaxed);
  }
}

void Conversation::written() {
  const Outbox::Through through = outbox_.written();
  if (place_ != Place::inside || !(through.parcel || through.talk)) return;
  in_room([through](room::Room& room, room::ViewerId viewer) {
    if (through.parcel) room.ready(viewer);
    if (through.talk) room.heard(viewer);
  });
}

void Conversation::say(const protocol::ServerMessage& message) {
  outbox_.say(message);
  wake_();
}

void Conversation::done(std::optional<MessageId> id) {
  if (id)
    say(protocol::Done{*id});
  else
    wake_();
}

void Conversation::reject(std::optional<MessageId> id, Failure why) {
  count(why);
  say(protocol::Rejected{.id = id, .failure = std::move(why)});
}

void Conversation::count(const Failure& refused) {
  ++atlas_.meters().rejected[static_cast<std::size_t>(refused.code)];
}

void Conversation::refuse_unsupported(std::optional<MessageId> id, const char* what) {
  reject(id, {Code::not_supported, std::string(what) + " is not offered by this server", "type"});
}

void Conversation::say_bye(Failure why, std::optional<std::uint32_t> retry_after_ms) {
  if (ending_) return;
  ending_ = true;
  protocol::Bye bye{.failure = std::move(why), .retry_after_ms = retry_after_ms};
  if (bye.failure.code == Code::shutting_down) bye.retry_after_ms = kRestartMs;
  outbox_.end(std::move(bye));
  wake_();
}

void Conversation::abandon() {
  abandoned_ = true;
  wake_ = [] {};
  if (place_ != Place::inside) return;  // a join under way leaves once it is answered
  place_ = Place::leaving;
  in_room([](room::Room& room, room::ViewerId viewer) { room.leave(viewer); });
  room_.reset();
}

void Conversation::answered(std::vector<room::Reply> replies) {
  own_->post([self = shared_from_this(), told = std::move(replies)] {
    self->unanswered_ -= static_cast<int>(told.size());
    for (const room::Reply& reply : told) {
      if (const auto* refused = std::get_if<protocol::Rejected>(&reply))
        self->count(refused->failure);
      std::visit([&](const auto& message) { self->outbox_.say(message); }, reply);
    }
    self->wake_();
  });
}

void Conversation::deliver(room::Parcel parcel) {
  own_->post([self = shared_from_this(), parcel = std::move(parcel)]() mutable {
    self->outbox_.put(std::move(parcel));
    self->wake_();
  });
}

void Conversation::tell(room::Talk talk) {
  own_->post([self = shared_from_this(), talk = std::move(talk)]() mutable {
    self->outbox_.put(std::move(talk));
    self->wake_();
  });
}

void Conversation::settings(room::SharedText message) {
  own_->post([self = shared_from_this(), message = std::move(message)]() mutable {
    self->outbox_.put_settings(std::move(message));
    self->wake_();
  });
}

void Conversation::end(protocol::Bye bye) {
  own_->post([self = shared_from_this(), bye = std::move(bye)] {
    self->place_ = Place::leaving;
    self->room_.reset();
    self->say_bye(bye.failure, bye.retry_after_ms);
  });
}

}  // namespace earthwork::net
