#include "client/viewer/web/input_source.hpp"

#include <emscripten.h>
#include <emscripten/html5.h>

#include <string_view>

#include "client/viewer/web/browser.hpp"
#include "client/viewer/web/canvas.hpp"
#include "client/viewer/web/page_input.hpp"

namespace earthwork::viewer {
namespace {

InputListener& listener_of(void* user) { return *static_cast<InputListener*>(user); }

// The command key of a Mac is its control key.
template <class Event>
Modifiers modifiers_of(const Event& event) {
  return {.shift = event.shiftKey != 0,
          .control = event.ctrlKey != 0 || event.metaKey != 0,
          .alt = event.altKey != 0};
}

EM_BOOL on_wheel(int, const EmscriptenWheelEvent* event, void* user) {
  double width = 0, height = 0;
  emscripten_get_element_css_size(kCanvas, &width, &height);
  const auto mode = static_cast<std::uint32_t>(event->deltaMode);
  listener_of(user).wheeled(
      {.at = {static_cast<double>(event->mouse.targetX), static_cast<double>(event->mouse.targetY)},
       .dx = wheel_pixels(event->deltaX, mode, width),
       .dy = wheel_pixels(event->deltaY, mode, height),
       .modifiers = modifiers_of(event->mouse)});
  return EM_TRUE;
}

EM_BOOL on_key(int, const EmscriptenKeyboardEvent* event, void* user) {
  if (page_keeps(static_cast<Focus>(browser_focus(kCanvas)), event->key)) return EM_FALSE;
  if (std::string_view(event->key) == " ") {
    listener_of(user).space_held(true);
    return EM_TRUE;  // the page would scroll
  }
  const bool meant = listener_of(user).key_pressed(
      {.key = event->key, .modifiers = modifiers_of(*event), .repeat = event->repeat != 0});
  return meant ? EM_TRUE : EM_FALSE;
}

EM_BOOL on_key_up(int, const EmscriptenKeyboardEvent* event, void* user) {
  if (std::string_view(event->key) == " ") listener_of(user).space_held(false);
  return EM_FALSE;
}

// Its release would be told to another window.
EM_BOOL on_blur(int, const EmscriptenFocusEvent*, void* user) {
  listener_of(user).space_held(false);
  return EM_FALSE;
}

}  // namespace

void listen_to_input(InputListener& listener) {
  browser_listen_to_pointers(kCanvas, &listener);
  emscripten_set_wheel_callback(kCanvas, &listener, EM_FALSE, on_wheel);
  emscripten_set_keydown_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, &listener, EM_FALSE, on_key);
  emscripten_set_keyup_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, &listener, EM_FALSE, on_key_up);
  emscripten_set_blur_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, &listener, EM_FALSE, on_blur);
}

}  // namespace earthwork::viewer

extern "C" EMSCRIPTEN_KEEPALIVE void earthwork_pointer(void* listener, int phase, int kind,
                                                       int pointer, int dom_button, double x,
                                                       double y, int modifiers, bool last) {
  using namespace earthwork::viewer;
  const auto button = button_of(dom_button);
  if (!button) return;
  listener_of(listener).pointed({.phase = static_cast<PointerPhase>(phase),
                                 .kind = static_cast<PointerKind>(kind),
                                 .id = pointer,
                                 .button = *button,
                                 .at = {x, y},
                                 .modifiers = {.shift = (modifiers & 1) != 0,
                                               .control = (modifiers & 2) != 0,
                                               .alt = (modifiers & 4) != 0}},
                                last);
}
