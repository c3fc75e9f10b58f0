/// What people do with mouse, pen, fingers, wheel and keys on the page.
#pragma once

#include "client/viewer/input.hpp"

namespace earthwork::viewer {

/// Told from the browser's event loop.
class InputListener {
 public:
  /// `last` of those that the browser told together.
  virtual void pointed(const PointerEvent& event, bool last) = 0;
  virtual void wheeled(const WheelEvent& event) = 0;
  /// True when the key meant something, so that the page does nothing with it.
  virtual bool key_pressed(const KeyEvent& event) = 0;
  /// Space went down, where nothing else has a use for it; or up, or the window lost the keyboard.
  virtual void space_held(bool held) = 0;

 protected:
  ~InputListener() = default;
};

/// Listens on the canvas for all that points, and on the whole page for keys that nothing else has
/// a use for. A drag that leaves the canvas goes on, and is cancelled when the window loses the
/// keyboard. Once; `listener` lives as long as the page.
void listen_to_input(InputListener& listener);

}  // namespace earthwork::viewer
