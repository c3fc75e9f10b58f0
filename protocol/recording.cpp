#include "protocol/recording.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"
#include "protocol/message_fields.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::uint64_t read_u64(JsonFields& in, const char* key) {
  return parse_hex(in.hex_digits(key, 16)).value_or(0);
}

std::string text(const ordered_json& line) {
  return line.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

Result<RecordingHead> read_recording_head(std::string_view line) {
  auto object = parse_json(line, kMaxControlBytes);
  if (!object) return tl::unexpected<Failure>(std::move(object.error()));
  JsonFields in(*object, {}, Code::bad_message);
  RecordingHead head;
  if (const json* map = in.value("map")) {
    auto settings = read_settings(*map);
    if (!settings) return tl::unexpected<Failure>(std::move(settings.error()));
    head.settings = std::move(*settings);
  }
  if (in.has("epoch")) head.epoch = read_u64(in, "epoch");
  return in.result(std::move(head));
}

Result<RecordedEvent> read_recorded_event(std::string_view line) {
  auto object = parse_json(line, kMaxControlBytes);
  if (!object) return tl::unexpected<Failure>(std::move(object.error()));
  JsonFields in(*object, {}, Code::bad_message);
  RecordedEvent event{.seq = read_seq(in, "seq", 1),
                      .time_ms = in.integer("time", {-kMaxInteger, kMaxInteger}),
                      .author = read_u64(in, "author"),
                      .id = read_id(in),
                      .action = {},
                      .hash = read_u64(in, "hash")};
  if (in.failed()) return in.result(std::move(event));
  auto action = read_action(*object);
  if (!action) return tl::unexpected<Failure>(std::move(action.error()));
  event.action = std::move(*action);
  return event;
}

std::string write(const RecordingHead& head) {
  ordered_json line;
  line["map"] = write_settings(head.settings);
  if (head.epoch) line["epoch"] = hex(*head.epoch);
  return text(line);
}

std::string write(const RecordedEvent& event) {
  ordered_json line{
      {"seq", event.seq}, {"time", event.time_ms}, {"author", hex(event.author)}, {"id", event.id}};
  write_action(event.action, line);
  line["hash"] = hex(event.hash);
  return text(line);
}

}  // namespace earthwork::protocol
