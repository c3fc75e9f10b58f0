#include "client/viewer/shortcuts.hpp"

#include <array>
#include <string_view>

namespace earthwork::viewer {
namespace {

using Action = MoveCamera::Action;

struct Row {
  Shortcut what;
  std::array<std::string_view, 2> keys;  // the second may be empty
  const char* does;
};

constexpr std::array<Row, 28> kTable{{
    {BrushKey::fill, {"f", ""}, "Fill"},
    {BrushKey::empty, {"e", ""}, "Empty"},
    {BrushKey::swap_fill, {"x", ""}, "Swap fill and empty"},
    {BrushKey::circle, {"1", ""}, "Circle"},
    {BrushKey::square, {"2", ""}, "Square"},
    {BrushKey::smaller, {"[", ""}, "Radius smaller by 1"},
    {BrushKey::larger, {"]", ""}, "Radius larger by 1"},
    {BrushKey::much_smaller, {"{", ""}, "Radius smaller by 5"},
    {BrushKey::much_larger, {"}", ""}, "Radius larger by 5"},
    {BrushKey::next_snap, {"g", ""}, "Snap to nothing, voxel centres or lines"},
    {Tool::paint, {"b", ""}, "Paint with a drag"},
    {Tool::move, {"v", ""}, "Move the picture with a drag"},
    {StrokeKey::stamp, {"Enter", ""}, "Stamp in the middle of the picture"},
    {StrokeKey::escape, {"Escape", ""}, "End the stroke, stop following"},
    {BrushKey::layer_down, {",", "PageDown"}, "Next layer down"},
    {BrushKey::layer_up, {".", "PageUp"}, "Next layer up"},
    {Action::fit, {"h", "Home"}, "Show all of the map"},
    {Action::top, {"t", ""}, "Look straight down"},
    {Action::in, {"+", "="}, "Zoom in"},
    {Action::out, {"-", ""}, "Zoom out"},
    {Action::left, {"ArrowLeft", ""}, "Move left"},
    {Action::right, {"ArrowRight", ""}, "Move right"},
    {Action::up, {"ArrowUp", ""}, "Move up"},
    {Action::down, {"ArrowDown", ""}, "Move down"},
    {Action::turn_left, {"q", ""}, "Turn left"},
    {Action::turn_right, {"w", ""}, "Turn right"},
    {Action::tilt_up, {"a", ""}, "Tilt toward the horizon"},
    {Action::tilt_down, {"s", ""}, "Tilt toward straight down"},
}};

/// A letter is the same with shift or caps lock.
std::string lower_letter(const std::string& key) {
  if (key.size() != 1 || key[0] < 'A' || 'Z' < key[0]) return key;
  return {static_cast<char>(key[0] - 'A' + 'a')};
}

}  // namespace

std::optional<Shortcut> shortcut_of(const KeyEvent& event) {
  if (event.modifiers.control || event.modifiers.alt || event.key.empty()) return std::nullopt;
  const std::string key = lower_letter(event.key);
  for (const Row& row : kTable)
    for (const std::string_view known : row.keys)
      if (key == known) return row.what;
  return std::nullopt;
}

ShortcutsPart shortcuts() {
  ShortcutsPart part;
  for (const Row& row : kTable) {
    auto& shown = part.shortcuts.emplace_back();
    shown.does = row.does;
    for (const std::string_view key : row.keys)
      if (!key.empty()) shown.keys.emplace_back(key);
  }
  return part;
}

}  // namespace earthwork::viewer
