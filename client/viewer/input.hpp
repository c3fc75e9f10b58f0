/// What pointers and keys did, in the words of no toolkit.
#pragma once

#include <cstdint>
#include <string>

#include "client/scene/camera.hpp"

namespace earthwork::viewer {

struct Modifiers {
  bool shift = false, control = false, alt = false;
};

enum class PointerKind : std::uint8_t { mouse, pen, touch };
enum class PointerPhase : std::uint8_t {
  press,
  move,  ///< With or without a button down.
  release,
  cancel,  ///< Taken away by the system: what it did is not wanted.
  leave,   ///< A mouse left the picture, without a button down.
};
enum class PointerButton : std::uint8_t { none, left, middle, right };

struct PointerEvent {
  PointerPhase phase = PointerPhase::move;
  PointerKind kind = PointerKind::mouse;
  std::int32_t id = 0;                         ///< Of a finger; one of each mouse or pen.
  PointerButton button = PointerButton::none;  ///< That went down or up.
  scene::ScreenPoint at;
  Modifiers modifiers;
};

struct WheelEvent {
  scene::ScreenPoint at;
  double dx = 0, dy = 0;  ///< CSS pixels to scroll; positive is right and down.
  /// A trackpad's pinch comes as a wheel with control.
  Modifiers modifiers;
};

struct KeyEvent {
  std::string key;  ///< As a browser's KeyboardEvent.key: "a", "+", "ArrowLeft", "Escape".
  Modifiers modifiers;
  bool repeat = false;
};

}  // namespace earthwork::viewer
