/// What keys do: one table, for the keyboard and for the dialog that explains it.
///
/// | keys | |
/// |---|---|
/// | f, e, x | fill, empty, the other of the two |
/// | 1, 2 | circle, square |
/// | [ ] and { } | radius by 1 and by 5 voxels |
/// | g | next way to snap |
/// | b, v | paint tool, move tool |
/// | Enter | a stamp in the middle of the picture |
/// | Escape | ends a stroke, stops following |
/// | , and PageDown; . and PageUp | next layer down, up |
/// | h or Home, t | all of the map, straight down |
/// | + or =, - | zoom |
/// | arrows | pan |
/// | q, w and a, s | turn and tilt |
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "client/viewer/input.hpp"
#include "client/viewer/panel_command.hpp"
#include "client/viewer/panel_state.hpp"

namespace earthwork::viewer {

enum class BrushKey : std::uint8_t {
  fill,
  empty,
  swap_fill,
  circle,
  square,
  smaller,
  larger,
  much_smaller,
  much_larger,
  next_snap,
  layer_down,
  layer_up,
};
enum class StrokeKey : std::uint8_t { stamp, escape };

using Shortcut = std::variant<BrushKey, StrokeKey, Tool, MoveCamera::Action>;

/// What the key does; nothing with control or alt, which are the browser's, or for another key.
[[nodiscard]] std::optional<Shortcut> shortcut_of(const KeyEvent& event);
/// The table, for people.
[[nodiscard]] ShortcutsPart shortcuts();

}  // namespace earthwork::viewer
