#include "client/viewer/web/page_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace earthwork::viewer {
namespace {

constexpr double kLinePixels = 16;
constexpr std::uint32_t kLines = 1, kPages = 2;  // WheelEvent.deltaMode

constexpr std::array<std::string_view, 9> kMoving{
    "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown", " "};

}  // namespace

std::optional<PointerButton> button_of(int dom_button) {
  switch (dom_button) {
    case -1:
      return PointerButton::none;
    case 0:
      return PointerButton::left;
    case 1:
      return PointerButton::middle;
    case 2:
      return PointerButton::right;
    default:
      return std::nullopt;
  }
}

double wheel_pixels(double delta, std::uint32_t mode, double page_pixels) {
  const double unit = mode == kLines ? kLinePixels : mode == kPages ? page_pixels : 1;
  const double pixels = delta * unit;
  return std::isfinite(pixels) ? pixels : 0;
}

bool page_keeps(Focus focus, std::string_view key) {
  switch (focus) {
    case Focus::map:
      return false;
    case Focus::all_keys:
      return true;
    case Focus::moves:
      return std::find(kMoving.begin(), kMoving.end(), key) != kMoving.end();
    case Focus::presses:
      return key == "Enter" || key == " ";
  }
  return true;
}

}  // namespace earthwork::viewer
