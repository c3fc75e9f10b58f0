#include "client/link/maps.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "client/link/http_client.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"

namespace earthwork::link {
namespace {

using nlohmann::json;
using protocol::Code;
using protocol::fail;
using protocol::Failure;

constexpr std::size_t kMaxMapInfoBytes = 1024 * 1024;
constexpr int kCreated = 201, kOk = 200, kNotFound = 404, kConflict = 409;

Code code_of(int status) {
  if (status == kConflict) return Code::map_exists;
  return status == kNotFound ? Code::unknown_map : Code::bad_message;
}

/// What a problem document says, or the status alone where the body is none.
Failure problem_of(const ServerAddress& server, const HttpAnswer& answer) {
  Failure failure{.code = code_of(answer.status),
                  .detail = server.text() + " answers " + std::to_string(answer.status),
                  .field = {}};
  const auto document = protocol::parse_json(answer.body, kMaxMapInfoBytes);
  if (!document || !document->is_object()) return failure;
  for (const char* key : {"title", "detail"}) {
    const auto text = document->find(key);
    if (text != document->end() && text->is_string())
      failure.detail += ": " + text->get<std::string>();
  }
  return failure;
}

protocol::Result<MapInfo> read_info(std::string_view body) {
  auto document = protocol::parse_json(body, kMaxMapInfoBytes);
  if (!document) return tl::unexpected<Failure>(std::move(document.error()));
  protocol::JsonFields in(*document);
  MapInfo info;
  info.seq = static_cast<std::uint64_t>(in.integer("seq"));
  info.chunks = static_cast<std::uint64_t>(in.integer("chunks"));
  if (const json* object = in.value("settings")) {
    auto settings = protocol::read_settings(*object);
    if (!settings) return tl::unexpected<Failure>(std::move(settings.error()));
    info.settings = std::move(*settings);
  }
  return in.result(std::move(info));
}

}  // namespace

protocol::Result<void> create_map(const ServerAddress& server, const std::string& name,
                                  const protocol::MapSettings& settings) {
  const json body{{"name", name}, {"settings", protocol::write_settings(settings)}};
  const auto answer = http_post(server, "/api/maps", body.dump());
  if (!answer) return tl::unexpected<Failure>(answer.error());
  if (answer->status == kCreated) return {};
  return tl::unexpected<Failure>(problem_of(server, *answer));
}

protocol::Result<MapInfo> map_info(const ServerAddress& server, const std::string& name) {
  if (!protocol::valid_map_name(name))
    return fail(Code::bad_name, "'" + name + "' is no map's name: 1-64 of a-z, 0-9, '-', '_'",
                "map");
  const auto answer = http_get(server, "/api/maps/" + name);
  if (!answer) return tl::unexpected<Failure>(answer.error());
  if (answer->status != kOk) return tl::unexpected<Failure>(problem_of(server, *answer));
  auto info = read_info(answer->body);
  if (!info)
    info.error().detail = server.text() + " sent no map's description: " + info.error().detail;
  return info;
}

}  // namespace earthwork::link
