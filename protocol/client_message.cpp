// What clients send: read on the server, written by bots and viewers.
#include <nlohmann/json.hpp>

#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/message_fields.hpp"
#include "protocol/messages.hpp"
#include "protocol/presence_fields.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Result<ClientMessage> read_hello(JsonFields& in) {
  Hello hello;
  const auto versions = in.integers("protocol", 2, {1, kMaxVersion});
  hello.protocol_min = static_cast<int>(versions[0]);
  hello.protocol_max = static_cast<int>(versions[1]);
  if (versions[0] > versions[1])
    in.refuse(Code::out_of_range, "protocol", "[min, max] needs min <= max");
  hello.name = in.name("name");
  if (in.has("color")) hello.color = in.color("color");
  if (in.has("key")) hello.key = in.hex_digits("key", kKeyDigits);
  hello.id = read_optional_id(in);
  return in.result<ClientMessage>(std::move(hello));
}

Result<ClientMessage> read_join(JsonFields& in) {
  Join join;
  join.map = in.map_name("map");
  if (in.has("seq")) join.seq = read_seq(in, "seq");
  join.id = read_optional_id(in);
  return in.result<ClientMessage>(std::move(join));
}

Result<ClientMessage> read_leave(JsonFields& in) {
  return in.result<ClientMessage>(Leave{read_optional_id(in)});
}

Result<Have> read_have(JsonFields in) {
  Have have;
  have.epoch = in.hex_digits("epoch", kEpochDigits);
  have.seq = read_seq(in, "seq");
  have.rect = read_rect(in, "rect");
  return in.result(std::move(have));
}

Result<ClientMessage> read_view(JsonFields& in) {
  View view;
  view.n = read_u32(in, "n");
  const bool all = in.has("all") && in.boolean("all");
  if (all && in.has("rect"))
    in.refuse(Code::bad_field, "all", "does not go with rect");
  else if (!all)
    view.rect = read_rect(in, "rect");
  if (const json* have = in.has("have") ? in.value("have") : nullptr) {
    auto read = read_have(JsonFields(*have, "have"));
    if (read)
      view.have = std::move(*read);
    else
      in.refuse(std::move(read.error()));
  }
  view.id = read_optional_id(in);
  return in.result<ClientMessage>(std::move(view));
}

Result<ClientMessage> read_edit_message(JsonFields& in, const json& object) {
  EditMessage message;
  message.id = read_id(in);
  if (in.failed()) return in.result<ClientMessage>(std::move(message));
  auto edit = read_edit(object);
  if (!edit) return tl::unexpected<Failure>(std::move(edit.error()));
  message.edit = std::move(*edit);
  return ClientMessage(std::move(message));
}

Result<ClientMessage> read_layer_message(JsonFields& in, const json& object) {
  LayerMessage message;
  message.id = read_id(in);
  if (in.failed()) return in.result<ClientMessage>(std::move(message));
  auto change = read_layer_change(object);
  if (!change) return tl::unexpected<Failure>(std::move(change.error()));
  message.change = std::move(*change);
  return ClientMessage(std::move(message));
}

Result<ClientMessage> read_cursor(JsonFields& in) {
  Cursor cursor{.at = read_place(in),
                .brush = read_brush(in),
                .view = read_seen(in),
                .id = read_optional_id(in)};
  return in.result<ClientMessage>(cursor);
}

Result<ClientMessage> read_chat(JsonFields& in) {
  Chat chat{.text = in.words("text", kMaxChatCharacters), .id = read_optional_id(in)};
  return in.result<ClientMessage>(std::move(chat));
}

Result<ClientMessage> read_events(JsonFields& in) {
  Events events{.from_seq = read_seq(in, "from_seq", 1), .id = read_optional_id(in)};
  return in.result<ClientMessage>(events);
}

Result<ClientMessage> read_message(const json& object) {
  JsonFields in(object, {}, Code::bad_message);
  const std::string type = in.text("type");
  if (in.failed()) return in.result(ClientMessage{});
  if (type == "edit") return read_edit_message(in, object);
  if (type == "cursor") return read_cursor(in);
  if (type == "layer") return read_layer_message(in, object);
  if (type == "chat") return read_chat(in);
  if (type == "ping") return in.result<ClientMessage>(Ping{read_optional_id(in)});
  if (type == "view") return read_view(in);
  if (type == "undo") return in.result<ClientMessage>(Undo{read_id(in)});
  if (type == "redo") return in.result<ClientMessage>(Redo{read_id(in)});
  if (type == "hello") return read_hello(in);
  if (type == "join") return read_join(in);
  if (type == "leave") return read_leave(in);
  if (type == "events") return read_events(in);
  return fail(Code::bad_message, "type: is no message of a client", "type");
}

/// Adds a message's fields after its type. One overload a message.
struct Writer {
  ordered_json& out;

  const char* operator()(const Hello& hello) const {
    out["protocol"] = {hello.protocol_min, hello.protocol_max};
    out["name"] = hello.name;
    if (hello.color) out["color"] = *hello.color;
    if (hello.key) out["key"] = *hello.key;
    return with_id("hello", hello.id);
  }
  const char* operator()(const Join& join) const {
    out["map"] = join.map;
    if (join.seq) out["seq"] = *join.seq;
    return with_id("join", join.id);
  }
  const char* operator()(const Leave& leave) const { return with_id("leave", leave.id); }
  const char* operator()(const View& view) const {
    out["n"] = view.n;
    if (view.rect)
      out["rect"] = write_rect(*view.rect);
    else
      out["all"] = true;
    if (view.have)
      out["have"] = {{"epoch", view.have->epoch},
                     {"seq", view.have->seq},
                     {"rect", write_rect(view.have->rect)}};
    return with_id("view", view.id);
  }
  const char* operator()(const EditMessage& message) const {
    with_id("edit", message.id);
    write_edit(message.edit, out);
    return "edit";
  }
  const char* operator()(const LayerMessage& message) const {
    with_id("layer", message.id);
    write_layer_change(message.change, out);
    return "layer";
  }
  const char* operator()(const Chat& chat) const {
    out["text"] = chat.text;
    return with_id("chat", chat.id);
  }
  const char* operator()(const Undo& undo) const { return with_id("undo", undo.id); }
  const char* operator()(const Redo& redo) const { return with_id("redo", redo.id); }
  const char* operator()(const Cursor& cursor) const {
    write_place(cursor.at, out);
    write_brush(cursor.brush, out);
    write_seen(cursor.view, out);
    return with_id("cursor", cursor.id);
  }
  const char* operator()(const Events& events) const {
    out["from_seq"] = events.from_seq;
    return with_id("events", events.id);
  }
  const char* operator()(const Ping& ping) const { return with_id("ping", ping.id); }

  const char* with_id(const char* type, std::optional<MessageId> id) const {
    if (id) out["id"] = *id;
    return type;
  }
};

}  // namespace

Result<ClientMessage> parse_client_message(std::string_view text) {
  auto object = parse_json(text, kMaxControlBytes);
  if (!object) return tl::unexpected<Failure>(std::move(object.error()));
  return read_message(*object);
}

std::string write(const ClientMessage& message) {
  ordered_json out{{"type", ""}};  // first, whatever follows
  out["type"] = std::visit(Writer{out}, message);
  return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace earthwork::protocol
