/// What panels ask a viewer to do. In the page a command is a JSON object: {"do": NAME, fields}.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "client/scene/brush.hpp"
#include "client/scene/camera.hpp"
#include "protocol/layer_change.hpp"
#include "protocol/result.hpp"

namespace earthwork::viewer {

enum class Tool : std::uint8_t { paint, move };

/// "tool": {"tool": "paint" | "move"}: what a drag with the first button or one finger does.
struct UseTool {
  Tool tool = Tool::paint;
};
/// "brush": any of {"stencil", "fill", "radius" (voxels, 0 .. 50), "layer", "snap": "none" |
/// "centres" | "lines"}. What is missing stays.
struct SetBrush {
  std::optional<protocol::StencilShape> stencil;
  std::optional<bool> fill;
  std::optional<double> radius_voxels;
  std::optional<std::uint32_t> layer;
  std::optional<scene::Snap> snap;
};
/// "show": {"layer", "visible"}: for this person only.
struct ShowLayer {
  std::uint32_t layer = 0;
  bool visible = true;
};
/// "layer": {"layer"?, "name"?, "color"?, "wall"?}, as the message of the protocol.
struct ChangeLayer {
  protocol::LayerChange change;
};
/// "camera": {"action": "fit" | "top" | "in" | "out" | "left" | "right" | "up" | "down" |
/// "turn_left" | "turn_right" | "tilt_up" | "tilt_down"}; or {"x", "y", "zoom", "yaw"?, "tilt"?}.
struct MoveCamera {
  enum class Action : std::uint8_t {
    fit,
    top,
    in,
    out,
    left,
    right,
    up,
    down,
    turn_left,
    turn_right,
    tilt_up,
    tilt_down,
    go
  };
  Action action = Action::fit;
  scene::Camera::Place place;  ///< Of `go`.
};
/// "stamp": {}: one stamp of the brush in the middle of the picture, for who has only keys.
struct StampHere {};
/// "chat": {"text"}.
struct Say {
  std::string text;
};
/// "follow": {"session"?}: the camera goes with theirs until one moves it oneself; none: no more.
struct Follow {
  std::optional<std::string> session;
};
/// "join": {"map"}: another map, with the same name and colour.
struct OpenMap {
  std::string map;
};
/// "person": {"name", "color"}: who one is from now on; connects anew.
struct BePerson {
  std::string name, color;
};
/// "retry": {}: does not wait longer to connect again.
struct RetryNow {};

using PanelCommand = std::variant<UseTool, SetBrush, ShowLayer, ChangeLayer, MoveCamera, StampHere,
                                  Say, Follow, OpenMap, BePerson, RetryNow>;

/// A command of the page. Fails with bad_json, bad_message, bad_field or out_of_range.
[[nodiscard]] protocol::Result<PanelCommand> read_panel_command(std::string_view json);

}  // namespace earthwork::viewer
