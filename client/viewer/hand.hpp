/// What pointers and wheels mean: the camera is moved by them at once, and the brush is told what
/// to do.
///
/// | what | does |
/// |---|---|
/// | left button, one finger, pen | the tool: paints, or moves the map |
/// | middle button; left with shift or while space is held | moves the map |
/// | right button; left with alt | turns (sideways) and tilts (up and down) |
/// | two fingers | move, zoom and, once twisted by 10 degrees, turn; the one that stays moves |
/// | wheel | zooms to the pointer; further sideways than up or down, it moves the map sideways |
/// | wheel with control, a trackpad's pinch | zooms to the pointer, as fingers do |
/// | wheel with shift | the brush's radius |
///
/// One drag at a time: until its button is up or its finger lifted, other buttons, pens and mice do
/// nothing, and neither do fingers beside a pen or mouse (a palm), or a third one.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/scene/camera.hpp"
#include "client/viewer/input.hpp"
#include "client/viewer/panel_command.hpp"

namespace earthwork::viewer {

/// A finger that moves less within that time may be the first of two: it paints nothing yet. When
/// it is lifted, it has tapped: one stamp.
inline constexpr double kTapPixels = 10;
inline constexpr std::chrono::milliseconds kTapTime{250};

/// Within one drag: begin, then any number of draws, then end or cancel.
struct BrushAct {
  enum class Kind : std::uint8_t {
    begin,
    draw,    ///< In a straight line from the last place.
    end,     ///< Where it is.
    cancel,  ///< What was not sent yet is not wanted.
  };
  Kind kind = Kind::begin;
  protocol::MapPoint at{};  ///< Of begin and draw: on the plane of the brush.
  friend bool operator==(const BrushAct&, const BrushAct&) = default;
};

struct HandOutcome {
  std::vector<BrushAct> brush{};  ///< In order.
  int radius_steps = 0;           ///< To make the brush larger by; a notch of the wheel is one.
  bool camera_moved = false;
  friend bool operator==(const HandOutcome&, const HandOutcome&) = default;
};

/// One thread.
class Hand {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// What a pointer acts upon.
  struct Reach {
    scene::Camera& camera;
    Tool tool = Tool::paint;
    double height = 0;  ///< Of the plane that the brush paints: the top of its layer.
  };

  /// Space was pressed (true) or released. It counts for drags that begin.
  void set_space(bool held) { space_ = held; }
  /// A place that is not finite is none: such a press or move does nothing.
  [[nodiscard]] HandOutcome pointer(const PointerEvent& event, const Reach& reach, Time now);
  [[nodiscard]] HandOutcome wheel(const WheelEvent& event, scene::Camera& camera);
  /// Escape, or the keyboard went elsewhere: whatever is going on is over, without an act; the
  /// stroke that was begun is the caller's to cancel. Buttons and fingers that are still down do
  /// nothing until they are pressed again.
  void cancel();

  /// A stroke was begun and has not ended.
  [[nodiscard]] bool paints() const { return drag_ && drag_->does == Does::paint; }
  /// Where the brush is to be shown, on the screen: under a mouse, a pen, or the finger that
  /// paints; nowhere when they have left.
  [[nodiscard]] std::optional<scene::ScreenPoint> over() const { return over_; }

 private:
  enum class Does : std::uint8_t {
    wait,  ///< It may become a stroke, a tap, or the first of two fingers.
    paint,
    move,
    turn,
  };
  struct Drag {
    std::int32_t id = 0;
    PointerKind kind = PointerKind::mouse;
    PointerButton button = PointerButton::none;
    Does does = Does::paint;
    scene::ScreenPoint began, last;
    Time since;
  };
  struct Finger {
    std::int32_t id = 0;
    scene::ScreenPoint at;
  };
  /// Both are down; they do nothing else.
  struct Pinch {
    Finger a, b;
    double twist = 0;  ///< Radians, before it turns.
    bool turns = false;
  };

  void press(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out);
  void press_second(const PointerEvent& event, HandOutcome& out);
  void move(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out);
  void release(const PointerEvent& event, const Reach& reach, Time now, HandOutcome& out);
  void take_away(const PointerEvent& event, Time now, HandOutcome& out);
  [[nodiscard]] std::optional<Does> meaning(const PointerEvent& event, Tool tool) const;
  void begin(const Reach& reach, HandOutcome& out);
  void drag_to(scene::ScreenPoint at, const Reach& reach, Time now, HandOutcome& out);
  void pinch_to(const PointerEvent& event, scene::Camera& camera);
  void leave_pinch(std::int32_t id, Time now);
  [[nodiscard]] int radius_steps(double larger_pixels);

  bool space_ = false;
  std::optional<Drag> drag_;
  std::optional<Pinch> pinch_;
  std::optional<scene::ScreenPoint> over_;
  double radius_pixels_ = 0;  // scrolled toward the next step, positive is larger
};

}  // namespace earthwork::viewer
