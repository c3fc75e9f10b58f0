/// The control messages: JSON text, one object a message, "type" first when written.
///
/// `parse_*` checks a message completely: size, depth, UTF-8, types, ranges. What it returns can
/// be used as it is, apart from the limits that need a map (`check_edit`).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/action.hpp"
#include "protocol/chunk_range.hpp"
#include "protocol/edit.hpp"
#include "protocol/json_text.hpp"
#include "protocol/layer_change.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

/// Message ids are integers 1 .. 2^53 - 1, chosen by the client.
using MessageId = std::int64_t;

struct Hello {
  int protocol_min = kMinProtocol, protocol_max = kMaxProtocol;
  std::string name;                  ///< 1 .. 64 characters.
  std::optional<std::string> color;  ///< "#rrggbb".
  std::optional<std::string> key;    ///< 32 hex digits: who the client was before.
  std::optional<MessageId> id;
  static constexpr int kMinProtocol = 1, kMaxProtocol = 1;
  friend bool operator==(const Hello&, const Hello&) = default;
};
struct Join {
  std::string map;
  std::optional<std::uint64_t> seq;
  std::optional<MessageId> id;
  friend bool operator==(const Join&, const Join&) = default;
};
struct Leave {
  std::optional<MessageId> id;
  friend bool operator==(const Leave&, const Leave&) = default;
};
/// What a view's sender already has: complete up to seq inside rect, in that epoch.
struct Have {
  std::string epoch;
  std::uint64_t seq = 0;
  MapRect rect;
  friend bool operator==(const Have&, const Have&) = default;
};
struct View {
  std::uint32_t n = 0;          ///< Chosen by the client; echoed in groups and caught_up.
  std::optional<MapRect> rect;  ///< None: everything ("all": true).
  std::optional<Have> have;
  std::optional<MessageId> id;
  friend bool operator==(const View&, const View&) = default;
};
struct EditMessage {
  MessageId id = 0;
  Edit edit;
  friend bool operator==(const EditMessage&, const EditMessage&) = default;
};
struct Undo {
  MessageId id = 0;
  friend bool operator==(const Undo&, const Undo&) = default;
};
struct Redo {
  MessageId id = 0;
  friend bool operator==(const Redo&, const Redo&) = default;
};
/// Adds a layer or changes one; answered and remembered like an edit.
struct LayerMessage {
  MessageId id = 0;
  LayerChange change;
  friend bool operator==(const LayerMessage&, const LayerMessage&) = default;
};
/// Something said to all who are on the map.
struct Chat {
  std::string text;  ///< 1 .. kMaxChatCharacters characters, no control character.
  std::optional<MessageId> id;
  friend bool operator==(const Chat&, const Chat&) = default;
};
/// What somebody would paint with.
struct Brush {
  StencilShape stencil = StencilShape::circle;
  double radius = 0;  ///< Map units.
  bool fill = true;
  std::uint32_t layer = 0;
  friend bool operator==(const Brush&, const Brush&) = default;
};
/// Where somebody points, for the others to see.
struct Cursor {
  std::optional<MapPoint> at;  ///< Map units; none: nowhere ("hidden": true).
  std::optional<Brush> brush;
  std::optional<MapRect> view;  ///< The part of the map that somebody sees, for who follows.
  std::optional<MessageId> id;
  friend bool operator==(const Cursor&, const Cursor&) = default;
};
/// All that the map accepted from that seq on, and what it accepts from now on.
struct Events {
  std::uint64_t from_seq = 1;
  std::optional<MessageId> id;
  friend bool operator==(const Events&, const Events&) = default;
};
struct Ping {
  std::optional<MessageId> id;
  friend bool operator==(const Ping&, const Ping&) = default;
};
using ClientMessage = std::variant<Hello, Join, Leave, View, EditMessage, LayerMessage, Undo, Redo,
                                   Cursor, Chat, Events, Ping>;

struct Welcome {
  std::string session;          ///< Names the session to people and logs; 16 hex digits.
  std::string key;              ///< 32 hex digits, a secret.
  int protocol = 1;             ///< The version both will speak.
  std::optional<MessageId> id;  ///< Of the hello, like every reply's. The limits are written from
                                ///< protocol/limits.hpp and ignored when read.
  friend bool operator==(const Welcome&, const Welcome&) = default;
};
/// Somebody who has joined, under the identity that the server gave.
struct User {
  std::string session, name, color;
  std::string author;  ///< 16 hex digits: who its edits are by; the same whenever the key is.
  friend bool operator==(const User&, const User&) = default;
};
struct Joined {
  std::string map;
  MapSettings settings;
  std::string epoch;  ///< 16 hex digits.
  std::uint64_t seq = 0;
  std::vector<User> users;
  std::optional<MessageId> id;
  friend bool operator==(const Joined&, const Joined&) = default;
};
struct Applied {
  MessageId id = 0;
  std::uint64_t seq = 0;
  friend bool operator==(const Applied&, const Applied&) = default;
};
/// `id` is missing when the refused message had none that could be read.
struct Rejected {
  std::optional<MessageId> id;
  Failure failure;  ///< Written as code, message and, unless empty, field.
  friend bool operator==(const Rejected&, const Rejected&) = default;
};
struct CaughtUp {
  std::uint32_t n = 0;
  std::uint64_t seq = 0;
  friend bool operator==(const CaughtUp&, const CaughtUp&) = default;
};
/// The reply to ping, leave, view, cursor and events messages that carry an id.
struct Done {
  MessageId id = 0;
  friend bool operator==(const Done&, const Done&) = default;
};
struct UserCursor {
  std::string session;
  std::optional<MapPoint> at;  ///< None: it has no cursor any more.
  std::optional<Brush> brush;
  std::optional<MapRect> view;  ///< As of Cursor.
  friend bool operator==(const UserCursor&, const UserCursor&) = default;
};
/// What is new among the people of a map. Written without the lists that are empty.
struct Presence {
  bool all = false;                 ///< Whoever is not among `users` is gone.
  std::vector<User> users;          ///< Who came.
  std::vector<std::string> left;    ///< Sessions that are gone, their cursors with them.
  std::vector<UserCursor> cursors;  ///< Those that moved.
  friend bool operator==(const Presence&, const Presence&) = default;
};
/// What was accepted.
struct Event {
  std::uint64_t seq = 0;
  std::int64_t time_ms = 0;  ///< Since 1970, UTC.
  std::string author;        ///< 16 hex digits, as of User.
  Action action;             ///< Written as its kind and fields.
  std::string hash;          ///< Of the map after it; 16 hex digits.
  friend bool operator==(const Event&, const Event&) = default;
};
/// The map's settings after its layers have changed; of several changes perhaps the last one only.
struct SettingsChanged {
  std::uint64_t seq = 0;  ///< Of the last change that they show.
  MapSettings settings;
  friend bool operator==(const SettingsChanged&, const SettingsChanged&) = default;
};
/// What was said, by whom. Name and colour are those of then.
struct ChatLine {
  std::uint64_t n = 0;       ///< 1, 2, 3 ... in a map, as long as its server runs.
  std::int64_t time_ms = 0;  ///< Since 1970, UTC.
  std::string session, name, color, text;
  friend bool operator==(const ChatLine&, const ChatLine&) = default;
};
/// New lines, in order: after a join those that are kept.
struct ChatLines {
  std::vector<ChatLine> lines;
  friend bool operator==(const ChatLines&, const ChatLines&) = default;
};
struct Bye {
  Failure failure;  ///< Written as code and message.
  std::optional<std::uint32_t> retry_after_ms;
  friend bool operator==(const Bye&, const Bye&) = default;
};
using ServerMessage = std::variant<Welcome, Joined, Applied, Rejected, CaughtUp, Done, Presence,
                                   Event, SettingsChanged, ChatLines, Bye>;

[[nodiscard]] Result<ClientMessage> parse_client_message(std::string_view text);
[[nodiscard]] std::string write(const ClientMessage& message);
[[nodiscard]] Result<ServerMessage> parse_server_message(std::string_view text);
[[nodiscard]] std::string write(const ServerMessage& message);

/// The "id" of a message that could not be parsed, so that its refusal can carry it; nothing when
/// there is none to be found before the place where the text stops being JSON.
[[nodiscard]] std::optional<MessageId> salvage_id(std::string_view text);

/// A view's rectangle covers at most kMaxViewChunks chunks of a map with these settings.
[[nodiscard]] Result<void> check_view(const View& view, const MapSettings& settings);
/// What somebody sees lies within kMaxCoordinateVoxels of 0; the field is "view".
[[nodiscard]] Result<void> check_seen(const MapRect& view, const MapSettings& settings);

}  // namespace earthwork::protocol
