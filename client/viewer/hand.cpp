#include "client/viewer/hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace earthwork::viewer {

using scene::Camera;
using scene::ScreenPoint;
using Act = BrushAct::Kind;

namespace {

constexpr double kTurnPerPixel = 0.008, kTiltPerPixel = 0.006;  // radians
constexpr double kTwistBeforeTurn = 10 * std::numbers::pi / 180;
/// Fingers that are closer say nothing of distance and direction.
constexpr double kPinchPixels = 8;

constexpr double kZoomPerPixel = 0.002;  // of the factor's logarithm: a notch is some 25 %
/// What browsers make of a pinch: the factor's logarithm, times 100. A wheel's notch with control
/// arrives by the same way and is kept from being a leap.
constexpr double kPinchZoomPerPixel = 0.01, kMaxPinchPixels = 25;
constexpr double kMaxWheelPixels = 1000;  // of one event
/// Wheels differ in how long a notch is, so one that is as long as this is one step.
constexpr double kRadiusStepPixels = 30;

bool finite(ScreenPoint at) { return std::isfinite(at.x) && std::isfinite(at.y); }
double distance(ScreenPoint a, ScreenPoint b) { return std::hypot(b.x - a.x, b.y - a.y); }
ScreenPoint middle(ScreenPoint a, ScreenPoint b) { return {(a.x + b.x) / 2, (a.y + b.y) / 2}; }
/// Clockwise, for y is downward.
double direction(ScreenPoint a, ScreenPoint b) { return std::atan2(b.y - a.y, b.x - a.x); }

/// The ground under `at` stays there while all else turns about it.
void turn_at(Camera& camera, ScreenPoint at, double yaw) {
  const auto held = camera.ground(at);
  camera.orbit(yaw, 0);
  if (!held) return;
  if (const auto now = camera.screen({held->x, held->y, 0})) camera.pan(*now, at);
}

}  // namespace

HandOutcome Hand::pointer(const PointerEvent& event, const Reach& reach, Time now) {
  HandOutcome out;
  const Camera::Place before = reach.camera.place();
  switch (event.phase) {
    case PointerPhase::press:
      if (finite(event.at)) press(event, reach, now, out);
      break;
    case PointerPhase::move:
      if (finite(event.at)) move(event, reach, now, out);
      break;
    case PointerPhase::release:
      release(event, reach, now, out);
      break;
    case PointerPhase::cancel:
      take_away(event, now, out);
      break;
    case PointerPhase::leave:
      if (!drag_) over_.reset();
      break;
  }
  out.camera_moved = reach.camera.place() != before;
  return out;
}

void Hand::cancel() {
  drag_.reset();
  pinch_.reset();
}

void Hand::press(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out) {
  const bool touch = event.kind == PointerKind::touch;
  if (pinch_) return;
  if (drag_ && drag_->id != event.id) {
    if (touch && drag_->kind == PointerKind::touch) press_second(event, out);
    return;
  }
  if (drag_) {
    if (drag_->button != event.button) return;
    // It went down again, so it must have gone up where nobody saw it.
    if (paints()) out.brush.push_back({.kind = Act::end});
    drag_.reset();
  }
  const std::optional<Does> does = meaning(event, reach.tool);
  if (!does) return;
  drag_ = Drag{.id = event.id,
               .kind = event.kind,
               .button = event.button,
               .does = *does,
               .began = event.at,
               .last = event.at,
               .since = now};
  over_.reset();
  if (!touch || does == Does::wait) over_ = event.at;
  if (does == Does::paint) begin(reach, out);
}

/// None for a button that means nothing.
std::optional<Hand::Does> Hand::meaning(const PointerEvent& event, Tool tool) const {
  if (event.kind == PointerKind::touch) return tool == Tool::move ? Does::move : Does::wait;
  switch (event.button) {
    case PointerButton::none:
      return std::nullopt;
    case PointerButton::left:
      if (event.modifiers.alt) return Does::turn;
      if (space_ || event.modifiers.shift || tool == Tool::move) return Does::move;
      return Does::paint;
    case PointerButton::middle:
      return Does::move;
    case PointerButton::right:
      return Does::turn;
  }
  return std::nullopt;
}

/// With the finger that drags already. What that one has painted is sent and stays.
void Hand::press_second(const PointerEvent& event, HandOutcome& out) {
  if (paints()) out.brush.push_back({.kind = Act::end});
  pinch_ = Pinch{.a = {.id = drag_->id, .at = drag_->last}, .b = {.id = event.id, .at = event.at}};
  drag_.reset();
  over_.reset();
}

void Hand::move(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out) {
  if (pinch_) {
    pinch_to(event, reach.camera);
  } else if (drag_) {
    if (drag_->id == event.id) drag_to(event.at, reach, now, out);
  } else if (event.kind != PointerKind::touch) {
    over_ = event.at;
  }
}

void Hand::release(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out) {
  if (pinch_) return leave_pinch(event.id, now);
  if (!drag_ || drag_->id != event.id) return;
  const bool touch = event.kind == PointerKind::touch;
  if (!touch && event.button != PointerButton::none && event.button != drag_->button) return;
  if (finite(event.at)) drag_to(event.at, reach, now, out);
  if (drag_ && drag_->does == Does::wait) begin(reach, out);
  if (paints()) out.brush.push_back({.kind = Act::end});
  drag_.reset();
  if (touch) over_.reset();
}

void Hand::take_away(const PointerEvent& event, Time now, HandOutcome& out) {
  if (pinch_) return leave_pinch(event.id, now);
  if (drag_ && drag_->id != event.id) return;
  if (paints()) out.brush.push_back({.kind = Act::cancel});
  drag_.reset();
  over_.reset();
}

/// The finger that stays moves the map: after a pinch nobody wants to paint with it.
void Hand::leave_pinch(std::int32_t id, Time now) {
  if (pinch_->a.id != id && pinch_->b.id != id) return;
  const Finger& stays = pinch_->a.id == id ? pinch_->b : pinch_->a;
  drag_ = Drag{.id = stays.id,
               .kind = PointerKind::touch,
               .button = PointerButton::none,
               .does = Does::move,
               .began = stays.at,
               .last = stays.at,
               .since = now};
  pinch_.reset();
}

/// Where the drag began; where there is nothing to paint on, it is none.
void Hand::begin(const Reach& reach, HandOutcome& out) {
  const auto at = reach.camera.ground(drag_->began, reach.height);
  if (!at) return drag_.reset();
  drag_->does = Does::paint;
  out.brush.push_back({.kind = Act::begin, .at = *at});
}

void Hand::drag_to(ScreenPoint at, const Reach& reach, Time now, HandOutcome& out) {
  ScreenPoint from = std::exchange(drag_->last, at);
  if (over_) over_ = at;
  if (drag_->does == Does::wait) {
    if (distance(drag_->began, at) < kTapPixels && now - drag_->since < kTapTime) return;
    begin(reach, out);
    if (!drag_) return;
    from = drag_->began;
  }
  if (from == at) return;
  switch (drag_->does) {
    case Does::wait:
      break;
    case Does::paint:
      if (const auto to = reach.camera.ground(at, reach.height))
        out.brush.push_back({.kind = Act::draw, .at = *to});
      break;
    case Does::move:
      reach.camera.pan(from, at);
      break;
    case Does::turn:
      reach.camera.orbit((from.x - at.x) * kTurnPerPixel, (from.y - at.y) * kTiltPerPixel);
      break;
  }
}

void Hand::pinch_to(const PointerEvent& event, Camera& camera) {
  const bool first = pinch_->a.id == event.id;
  if (!first && pinch_->b.id != event.id) return;
  const ScreenPoint a = pinch_->a.at, b = pinch_->b.at;
  (first ? pinch_->a.at : pinch_->b.at) = event.at;
  const ScreenPoint a_now = pinch_->a.at, b_now = pinch_->b.at, about = middle(a_now, b_now);
  camera.pan(middle(a, b), about);

  const double apart = distance(a, b), apart_now = distance(a_now, b_now);
  if (std::min(apart, apart_now) < kPinchPixels) return;
  camera.zoom_at(about, apart_now / apart);
  const double twist =
      std::remainder(direction(a_now, b_now) - direction(a, b), 2 * std::numbers::pi);
  if (pinch_->turns) return turn_at(camera, about, twist);
  pinch_->twist += twist;
  pinch_->turns = std::abs(pinch_->twist) > kTwistBeforeTurn;
}

HandOutcome Hand::wheel(const WheelEvent& event, Camera& camera) {
  if (!std::isfinite(event.dx) || !std::isfinite(event.dy)) return {};
  const double dx = std::clamp(event.dx, -kMaxWheelPixels, kMaxWheelPixels);
  const double dy = std::clamp(event.dy, -kMaxWheelPixels, kMaxWheelPixels);
  // With shift some browsers scroll sideways.
  if (event.modifiers.shift) return {.radius_steps = radius_steps(dy != 0 ? -dy : -dx)};
  const Camera::Place before = camera.place();
  if (event.modifiers.control)
    camera.zoom_at(event.at, std::exp(-std::clamp(dy, -kMaxPinchPixels, kMaxPinchPixels) *
                                      kPinchZoomPerPixel));
  else if (std::abs(dx) > std::abs(dy))
    camera.pan(event.at, {event.at.x - dx, event.at.y});
  else
    camera.zoom_at(event.at, std::exp(-dy * kZoomPerPixel));
  return {.camera_moved = camera.place() != before};
}

/// Fine scrolling adds up to steps; a notch is one by itself.
int Hand::radius_steps(double larger_pixels) {
  if (larger_pixels * radius_pixels_ < 0) radius_pixels_ = 0;
  radius_pixels_ += larger_pixels;
  if (std::abs(radius_pixels_) < kRadiusStepPixels) return 0;
  const int step = radius_pixels_ > 0 ? 1 : -1;
  radius_pixels_ = 0;
  return step;
}

}  // namespace earthwork::viewer
