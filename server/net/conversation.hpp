/// What is said in one session: client messages in, replies and parcels out. It knows the
/// protocol's states, and no socket.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/net/chat_rate.hpp"
#include "server/net/outbox.hpp"
#include "server/room/atlas.hpp"
#include "server/room/room.hpp"
#include "server/room/strand.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::net {

/// Edits and views that may be unanswered at a time. More are not refused, they are not read.
inline constexpr int kMaxUnanswered = 64;
/// Beyond this much unread control nothing is read either.
inline constexpr std::size_t kMaxControlWaiting = 64 * 1024;

/// All on the session's strand, except what it has of Viewer: rooms call that on theirs.
class Conversation final : public room::Viewer, public std::enable_shared_from_this<Conversation> {
 public:
  /// `own` is the session's strand. `wake` is called there when there may be something to write,
  /// or to read again. The atlas must outlive the conversation.
  Conversation(room::Atlas& atlas, std::unique_ptr<room::Strand> own, std::function<void()> wake);

  /// A text message from the client.
  void receive(std::string_view text);
  /// A binary message, of which there are none from clients.
  void refuse_binary();
  /// The next message is to be read now. While a join, which may have to wait for a map to be
  /// opened, or a leave is under way it is not.
  [[nodiscard]] bool may_read() const;
  [[nodiscard]] bool greeted() const { return !user_.session.empty(); }

  /// Appends what is to be written next, as `Outbox::take` does, and counts it in the meters.
  void take_output(std::string& out, std::size_t enough);
  /// All that was taken is written.
  void written();

  /// Says why, and ends.
  void say_bye(protocol::Failure why, std::optional<std::uint32_t> retry_after_ms = {});
  /// Nothing more will be said: bye was taken.
  [[nodiscard]] bool ended() const { return outbox_.ended(); }
  /// Bye was said, or is about to be.
  [[nodiscard]] bool ending() const { return ending_; }
  /// The socket is gone: leaves the room. `wake` is not called after it.
  void abandon();

  void answered(std::vector<room::Reply> replies) override;
  void deliver(room::Parcel parcel) override;
  void tell(room::Talk talk) override;
  void settings(room::SharedText message) override;
  void end(protocol::Bye bye) override;

 private:
  enum class Place { outside, entering, inside, leaving };

  void handle(protocol::Hello& hello);
  void handle(protocol::Join& join);
  void handle(const protocol::Leave& leave);
  void handle(protocol::View& view);
  void handle(protocol::EditMessage& edit) { submit(edit.id, std::move(edit.edit)); }
  void handle(protocol::LayerMessage& layer) { submit(layer.id, std::move(layer.change)); }
  void handle(const protocol::Ping& ping);
  void handle(const protocol::Undo& undo) { refuse_unsupported(undo.id, "undo"); }
  void handle(const protocol::Redo& redo) { refuse_unsupported(redo.id, "redo"); }
  void handle(protocol::Chat& chat);
  void handle(protocol::Cursor& cursor);
  void handle(const protocol::Events& events);

  void submit(protocol::MessageId id, protocol::Action action);
  void say(const protocol::ServerMessage& message);
  void done(std::optional<protocol::MessageId> id);
  void reject(std::optional<protocol::MessageId> id, protocol::Failure why);
  void count(const protocol::Failure& refused);
  void refuse_unsupported(std::optional<protocol::MessageId> id, const char* what);
  struct Wish {
    std::string map;
    protocol::User user;
    std::optional<protocol::MessageId> id;
    int tries;
  };
  /// Into the map's room; when that is found closed, into the one that comes after it, in so many
  /// tries. Any thread.
  void enter(Wish wish);
  void come_back(const std::shared_ptr<room::Room>& room,
                 protocol::Result<room::Room::Entrance> entrance,
                 std::optional<protocol::MessageId> id);
  void entered(const std::shared_ptr<room::Room>& room,
               protocol::Result<room::Room::Entrance> entrance,
               std::optional<protocol::MessageId> id);
  /// What the room made of a message that it answers at once.
  void answered(std::optional<protocol::MessageId> id, const protocol::Result<void>& result);
  void point(protocol::Cursor cursor);
  void pointed(std::optional<protocol::MessageId> id, const protocol::Result<void>& result);
  /// `ask(room, viewer)` on the room's strand; its result is the answer to the message with `id`.
  template <class Ask>
  void ask_room(std::optional<protocol::MessageId> id, Ask ask);
  /// `task(room, viewer)` on the room's strand.
  template <class Task>
  void in_room(Task task);
  template <class Task>
  void run_in(std::shared_ptr<room::Room> room, Task task);

  room::Atlas& atlas_;
  const std::unique_ptr<room::Strand> own_;
  std::function<void()> wake_;
  Outbox outbox_;
  protocol::User user_;  // its session is empty before the hello
  std::uint64_t author_ = 0;
  Place place_ = Place::outside;
  std::shared_ptr<room::Room> room_;  // while inside or leaving
  room::ViewerId viewer_ = 0;
  int unanswered_ = 0;
  int cursors_on_their_way_ = 0;
  std::optional<protocol::Cursor> next_cursor_;  // the latest one without an id
  ChatRate chat_rate_;
  bool ending_ = false, abandoned_ = false;
};

}  // namespace earthwork::net
