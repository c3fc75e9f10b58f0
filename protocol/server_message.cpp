// What a server sends: written on the server, read by bots and viewers.
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

/// Every limit of protocol/limits.hpp that a client meets, by its name there.
ordered_json write_limits() {
  return {
      {"max_control_bytes", kMaxControlBytes},
      {"max_server_control_bytes", kMaxServerControlBytes},
      {"max_integer", kMaxInteger},
      {"max_json_depth", kMaxJsonDepth},
      {"max_radius_voxels", kMaxRadiusVoxels},
      {"max_coordinate_voxels", kMaxCoordinateVoxels},
      {"max_path_points", kMaxPathPoints},
      {"max_edit_visits", kMaxEditVisits},
      {"max_edit_chunks", kMaxEditChunks},
      {"max_view_chunks", kMaxViewChunks},
      {"max_chunk_coordinate", kMaxChunkCoordinate},
      {"max_height", kMaxHeight},
      {"max_name_bytes", kMaxNameBytes},
      {"max_name_characters", kMaxNameCharacters},
      {"max_layers", kMaxLayers},
      {"max_chat_characters", kMaxChatCharacters},
      {"max_chat_lines", kMaxChatLines},
      {"chat_seconds", kChatSeconds},
      {"kept_chat_lines", kKeptChatLines},
      {"max_frame_bytes", kMaxFrameBytes},
      {"max_record_bytes", kMaxRecordBytes},
      {"max_vertices", kMaxVertices},
      {"mesh_coordinate_end", kMeshCoordinateEnd},
      {"max_wait_ms", kMaxWaitMs},
      {"max_remembered_ids", kMaxRememberedIds},
  };
}

Failure read_failure(JsonFields& in) {
  Failure failure;
  failure.code = code_named(in.text("code"));
  failure.detail = in.text("message");
  if (in.has("field")) failure.field = in.text("field");
  return failure;
}

Result<ServerMessage> read_welcome(JsonFields& in) {
  Welcome welcome;
  welcome.session = in.hex_digits("session", kSessionDigits);
  welcome.key = in.hex_digits("key", kKeyDigits);
  welcome.protocol = static_cast<int>(in.integer("protocol", {1, kMaxVersion}));
  welcome.id = read_optional_id(in);
  return in.result<ServerMessage>(std::move(welcome));
}

MapSettings read_settings_field(JsonFields& in) {
  const json* object = in.value("settings");
  if (!object) return {};
  auto settings = read_settings(*object);
  if (settings) return std::move(*settings);
  in.refuse(std::move(settings.error()));
  return {};
}

Result<ServerMessage> read_joined(JsonFields& in) {
  Joined joined;
  joined.map = in.map_name("map");
  joined.settings = read_settings_field(in);
  joined.epoch = in.hex_digits("epoch", kEpochDigits);
  joined.seq = read_seq(in);
  joined.users = read_users(in);
  joined.id = read_optional_id(in);
  return in.result<ServerMessage>(std::move(joined));
}

Result<ServerMessage> read_rejected(JsonFields& in) {
  Rejected rejected{.id = read_optional_id(in), .failure = read_failure(in)};
  return in.result<ServerMessage>(std::move(rejected));
}

Result<ServerMessage> read_event(JsonFields& in, const json& object) {
  Event event{.seq = read_seq(in, "seq", 1),
              .time_ms = in.integer("time", {-kMaxInteger, kMaxInteger}),
              .author = in.hex_digits("author", kAuthorDigits),
              .action = {},
              .hash = in.hex_digits("hash", kHashDigits)};
  static_cast<void>(in.text("kind"));  // here it must be said
  if (in.failed()) return in.result<ServerMessage>(std::move(event));
  auto action = read_action(object);
  if (!action) return tl::unexpected<Failure>(std::move(action.error()));
  event.action = std::move(*action);
  return ServerMessage(std::move(event));
}

Result<ServerMessage> read_settings_changed(JsonFields& in) {
  SettingsChanged changed{.seq = read_seq(in, "seq", 1), .settings = read_settings_field(in)};
  return in.result<ServerMessage>(std::move(changed));
}

Result<ChatLine> read_chat_line(JsonFields in) {
  ChatLine line{.n = read_seq(in, "n", 1),
                .time_ms = in.integer("time", {-kMaxInteger, kMaxInteger}),
                .session = in.hex_digits("session", kSessionDigits),
                .name = in.name("name"),
                .color = in.color("color"),
                .text = in.words("text", kMaxChatCharacters)};
  return in.result(std::move(line));
}

Result<ServerMessage> read_chat_lines(JsonFields& in) {
  ChatLines chat;
  const json* array = in.array("lines", 1, kKeptChatLines);
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    auto line = read_chat_line(JsonFields((*array)[i], "lines[" + std::to_string(i) + "]"));
    if (!line) return tl::unexpected<Failure>(std::move(line.error()));
    chat.lines.push_back(std::move(*line));
  }
  return in.result<ServerMessage>(std::move(chat));
}

Result<ServerMessage> read_bye(JsonFields& in) {
  Bye bye{.failure = read_failure(in), .retry_after_ms = {}};
  if (in.has("retry_after_ms")) bye.retry_after_ms = read_u32(in, "retry_after_ms");
  return in.result<ServerMessage>(std::move(bye));
}

Result<ServerMessage> read_message(const json& object) {
  JsonFields in(object, {}, Code::bad_message);
  const std::string type = in.text("type");
  if (in.failed()) return in.result(ServerMessage{});
  if (type == "applied")
    return in.result<ServerMessage>(Applied{.id = read_id(in), .seq = read_seq(in)});
  if (type == "rejected") return read_rejected(in);
  if (type == "caught_up")
    return in.result<ServerMessage>(CaughtUp{.n = read_u32(in, "n"), .seq = read_seq(in)});
  if (type == "done") return in.result<ServerMessage>(Done{.id = read_id(in)});
  if (type == "welcome") return read_welcome(in);
  if (type == "joined") return read_joined(in);
  if (type == "presence") return read_presence(in);
  if (type == "event") return read_event(in, object);
  if (type == "settings") return read_settings_changed(in);
  if (type == "chat") return read_chat_lines(in);
  if (type == "bye") return read_bye(in);
  return fail(Code::bad_message, "type: is no message of a server", "type");
}

/// Adds a message's fields after its type. One overload a message.
struct Writer {
  ordered_json& out;

  const char* operator()(const Welcome& welcome) const {
    out["session"] = welcome.session;
    out["key"] = welcome.key;
    out["protocol"] = welcome.protocol;
    out["limits"] = write_limits();
    return with_id("welcome", welcome.id);
  }
  const char* operator()(const Joined& joined) const {
    out["map"] = joined.map;
    out["settings"] = write_settings(joined.settings);
    out["epoch"] = joined.epoch;
    out["seq"] = joined.seq;
    out["users"] = write_users(joined.users);
    return with_id("joined", joined.id);
  }
  const char* operator()(const Applied& applied) const {
    with_id("applied", applied.id);
    out["seq"] = applied.seq;
    return "applied";
  }
  const char* operator()(const Rejected& rejected) const {
    with_id("rejected", rejected.id);
    write_failure(rejected.failure);
    return "rejected";
  }
  const char* operator()(const CaughtUp& caught_up) const {
    out["n"] = caught_up.n;
    out["seq"] = caught_up.seq;
    return "caught_up";
  }
  const char* operator()(const Done& done) const { return with_id("done", done.id); }
  const char* operator()(const Presence& presence) const {
    write_presence(presence, out);
    return "presence";
  }
  const char* operator()(const Event& event) const {
    out["seq"] = event.seq;
    out["time"] = event.time_ms;
    out["author"] = event.author;
    write_action(event.action, out);
    out["hash"] = event.hash;
    return "event";
  }
  const char* operator()(const SettingsChanged& changed) const {
    out["seq"] = changed.seq;
    out["settings"] = write_settings(changed.settings);
    return "settings";
  }
  const char* operator()(const ChatLines& chat) const {
    auto& lines = out["lines"] = ordered_json::array();
    for (const ChatLine& line : chat.lines)
      lines.push_back({{"n", line.n},
                       {"time", line.time_ms},
                       {"session", line.session},
                       {"name", line.name},
                       {"color", line.color},
                       {"text", line.text}});
    return "chat";
  }
  const char* operator()(const Bye& bye) const {
    write_failure(bye.failure);
    if (bye.retry_after_ms) out["retry_after_ms"] = *bye.retry_after_ms;
    return "bye";
  }

  void write_failure(const Failure& failure) const {
    out["code"] = name(failure.code);
    out["message"] = failure.detail;
    if (!failure.field.empty()) out["field"] = failure.field;
  }
  const char* with_id(const char* type, std::optional<MessageId> id) const {
    if (id) out["id"] = *id;
    return type;
  }
};

}  // namespace

Result<ServerMessage> parse_server_message(std::string_view text) {
  auto object = parse_json(text, kMaxServerControlBytes);
  if (!object) return tl::unexpected<Failure>(std::move(object.error()));
  return read_message(*object);
}

std::string write(const ServerMessage& message) {
  ordered_json out{{"type", ""}};  // first, whatever follows
  out["type"] = std::visit(Writer{out}, message);
  return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace earthwork::protocol
