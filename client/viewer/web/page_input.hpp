/// What the raw input of a page means. Numbers and names as the browser gives them come in, words
/// of the viewer go out; without a browser, so it is tested without one.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "client/viewer/input.hpp"

namespace earthwork::viewer {

/// Of MouseEvent.button; none for the keys at a mouse's side. -1 is that no button changed.
[[nodiscard]] std::optional<PointerButton> button_of(int dom_button);

/// CSS pixels of a WheelEvent's delta. `mode` is its deltaMode: pixels, lines or pages, of
/// `page_pixels` each; a mode that is not known counts as pixels. Of what is not finite: 0.
[[nodiscard]] double wheel_pixels(double delta, std::uint32_t mode, double page_pixels);

/// Which keys the element with the keyboard's focus has a use for.
enum class Focus : std::uint8_t {
  map,       ///< None: it is the map itself, or nothing.
  all_keys,  ///< A text field, a list, anything in a dialog.
  moves,     ///< A slider or a group of choices: arrows and the like, and the space bar.
  presses,   ///< A button or a link: Enter and the space bar.
};

/// True when the key is for the page; otherwise the viewer is asked.
[[nodiscard]] bool page_keeps(Focus focus, std::string_view key);

}  // namespace earthwork::viewer
