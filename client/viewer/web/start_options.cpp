#include "client/viewer/web/start_options.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"

namespace earthwork::viewer {
namespace {

using protocol::Code;
using protocol::JsonFields;

constexpr std::size_t kKeyDigits = 32;

// The camera keeps the place within the world; here it only has to be a place.
protocol::Result<scene::Camera::Place> read_place(const nlohmann::json& json) {
  JsonFields in(json, "place");
  scene::Camera::Place place;
  place.target = {in.number("x"), in.number("y")};
  place.zoom = in.number("zoom");
  if (in.has("yaw")) place.yaw = in.number("yaw");
  if (in.has("tilt")) place.tilt = in.number("tilt");
  if (!(place.zoom > 0)) in.refuse(Code::out_of_range, "zoom", "must be above 0");
  return in.result(place);
}

}  // namespace

protocol::Result<ViewerOptions> read_start_options(std::string_view text) {
  const auto json = protocol::parse_json(text, protocol::kMaxControlBytes);
  if (!json) return tl::unexpected<protocol::Failure>(json.error());

  JsonFields in(*json);
  ViewerOptions options;
  options.map = in.map_name("map");
  options.hello.name = in.name("name");
  if (in.has("color")) options.hello.color = in.color("color");
  if (in.has("key")) options.hello.key = in.hex_digits("key", kKeyDigits);
  if (in.has("last_id")) options.last_id = in.integer("last_id");
  if (in.has("seed")) options.seed = static_cast<std::uint64_t>(in.integer("seed"));
  if (in.has("place")) {
    auto place = read_place(*in.value("place"));
    if (place) {
      options.place = *place;
    } else {
      in.refuse(std::move(place.error()));
    }
  }
  return in.result(std::move(options));
}

}  // namespace earthwork::viewer
