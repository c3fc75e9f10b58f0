#include "client/viewer/panel_command.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"

namespace earthwork::viewer {
namespace {

using protocol::Code;
using protocol::JsonFields;
using protocol::Result;

constexpr std::size_t kSessionDigits = 16;

template <class T, std::size_t N>
using Names = std::array<std::pair<std::string_view, T>, N>;

using Action = MoveCamera::Action;
constexpr Names<Action, 12> kActions{{{"fit", Action::fit},
                                      {"top", Action::top},
                                      {"in", Action::in},
                                      {"out", Action::out},
                                      {"left", Action::left},
                                      {"right", Action::right},
                                      {"up", Action::up},
                                      {"down", Action::down},
                                      {"turn_left", Action::turn_left},
                                      {"turn_right", Action::turn_right},
                                      {"tilt_up", Action::tilt_up},
                                      {"tilt_down", Action::tilt_down}}};
constexpr Names<scene::Snap, 3> kSnaps{{{"none", scene::Snap::none},
                                        {"centres", scene::Snap::centres},
                                        {"lines", scene::Snap::lines}}};
constexpr Names<Tool, 2> kTools{{{"paint", Tool::paint}, {"move", Tool::move}}};

/// One of the names, or a refusal that lists them.
template <class T, std::size_t N>
T one_of(JsonFields& in, const char* key, const Names<T, N>& names) {
  const std::string text = in.text(key);
  std::string sentence = "is none of";
  for (const auto& [word, value] : names) {
    if (text == word) return value;
    sentence += " \"" + std::string(word) + "\"";
  }
  in.refuse(Code::bad_field, key, sentence);
  return names.front().second;
}

std::uint32_t layer_of(JsonFields& in) {
  return static_cast<std::uint32_t>(in.integer("layer", {0, protocol::kMaxLayers - 1}));
}

Result<PanelCommand> read_brush(JsonFields& in) {
  SetBrush brush;
  if (in.has("stencil")) brush.stencil = protocol::read_stencil(in);
  if (in.has("fill")) brush.fill = in.boolean("fill");
  if (in.has("layer")) brush.layer = layer_of(in);
  if (in.has("snap")) brush.snap = one_of(in, "snap", kSnaps);
  if (in.has("radius")) {
    brush.radius_voxels = in.number("radius");
    if (!(0 <= *brush.radius_voxels && *brush.radius_voxels <= scene::kMaxBrushVoxels))
      in.refuse(Code::out_of_range, "radius",
                "is outside 0 .. " + protocol::plain(scene::kMaxBrushVoxels) + " voxels");
  }
  return in.result<PanelCommand>(brush);
}

Result<PanelCommand> read_camera(JsonFields& in) {
  MoveCamera move;
  if (in.has("action")) {
    move.action = one_of(in, "action", kActions);
    return in.result<PanelCommand>(move);
  }
  move.action = Action::go;
  move.place.target = {.x = in.number("x"), .y = in.number("y")};
  move.place.zoom = in.number("zoom");
  if (!(move.place.zoom > 0)) in.refuse(Code::out_of_range, "zoom", "is not above 0");
  if (in.has("yaw")) move.place.yaw = in.number("yaw");
  if (in.has("tilt")) {
    move.place.tilt = in.number("tilt");
    if (!(0 <= move.place.tilt && move.place.tilt <= scene::kMaxTilt))
      in.refuse(Code::out_of_range, "tilt",
                "is outside 0 .. " + protocol::plain(scene::kMaxTilt) + " radians");
  }
  return in.result<PanelCommand>(move);
}

Result<PanelCommand> read_follow(JsonFields& in) {
  Follow follow;
  if (in.has("session")) follow.session = in.hex_digits("session", kSessionDigits);
  return in.result<PanelCommand>(std::move(follow));
}

Result<PanelCommand> read_person(JsonFields& in) {
  BePerson person{.name = in.name("name"), .color = in.color("color")};
  return in.result<PanelCommand>(std::move(person));
}

Result<PanelCommand> read_named(const std::string& what, JsonFields& in,
                                const nlohmann::json& json) {
  if (what == "tool") return in.result<PanelCommand>(UseTool{one_of(in, "tool", kTools)});
  if (what == "brush") return read_brush(in);
  if (what == "show")
    return in.result<PanelCommand>(
        ShowLayer{.layer = layer_of(in), .visible = in.boolean("visible")});
  if (what == "layer")
    return protocol::read_layer_change(json).map(
        [](auto&& change) -> PanelCommand { return ChangeLayer{std::move(change)}; });
  if (what == "camera") return read_camera(in);
  if (what == "stamp") return StampHere{};
  if (what == "chat")
    return in.result<PanelCommand>(Say{in.words("text", protocol::kMaxChatCharacters)});
  if (what == "follow") return read_follow(in);
  if (what == "join") return in.result<PanelCommand>(OpenMap{in.map_name("map")});
  if (what == "person") return read_person(in);
  if (what == "retry") return RetryNow{};
  return protocol::fail(Code::bad_message, "do: is no command of a panel", "do");
}

}  // namespace

Result<PanelCommand> read_panel_command(std::string_view json) {
  const auto object = protocol::parse_json(json, protocol::kMaxControlBytes);
  if (!object) return tl::unexpected(object.error());
  JsonFields in(*object, {}, Code::bad_message);
  const std::string what = in.text("do");
  if (in.failed()) return in.result<PanelCommand>(RetryNow{});
  return read_named(what, in, *object);
}

}  // namespace earthwork::viewer
