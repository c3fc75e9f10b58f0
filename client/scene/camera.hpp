/// From where a person looks at a map, in perspective: straight down at first, with x to the right.
///
/// The screen is measured in CSS pixels from the upper left corner, y downward, so nothing depends
/// on how fine a display is.
#pragma once

#include <optional>

#include "client/scene/vector.hpp"
#include "protocol/chunk_range.hpp"
#include "protocol/edit.hpp"

namespace earthwork::scene {

struct ScreenPoint {
  double x = 0, y = 0;
  friend bool operator==(const ScreenPoint&, const ScreenPoint&) = default;
};
struct ScreenSize {
  double width = 1, height = 1;
  friend bool operator==(const ScreenSize&, const ScreenSize&) = default;
};

inline constexpr double kMaxTilt = 1.3;  ///< Radians from straight down: the horizon stays outside.

class Camera {
 public:
  struct Place {
    protocol::MapPoint target;  ///< On height 0, in the middle of the screen; map units.
    double zoom = 16;           ///< CSS pixels a map unit has at the target.
    double yaw = 0;             ///< Radians, counter-clockwise seen from above: what is up.
    double tilt = 0;            ///< Radians, 0 (straight down) .. kMaxTilt.
    friend bool operator==(const Place&, const Place&) = default;
  };

  /// Zoom is kept between 4,000,000 voxels on the screen's shorter side, where all of the world is
  /// seen however it is turned, and 1 voxel on 400 pixels; the target within the world.
  /// `voxel_size` in map units; one that is not finite and positive stays as it was.
  void set_voxel_size(double voxel_size);
  /// At least 1 x 1; what is not finite stays as it was.
  void resize(ScreenSize size);
  [[nodiscard]] ScreenSize size() const { return size_; }
  [[nodiscard]] const Place& place() const { return place_; }
  /// Clamped, the yaw to -pi .. pi by whole turns; what is not finite stays as it was.
  void set(const Place& place);

  /// The ground (height 0) under `from` comes to lie under `to`. Nothing happens when one of them
  /// is so far above the screen that no ground is there, or at the horizon.
  void pan(ScreenPoint from, ScreenPoint to);
  /// What lies under `at` on the ground stays there; the target, where there is no ground.
  void zoom_at(ScreenPoint at, double factor);
  /// About the target, in radians.
  void orbit(double yaw, double tilt);
  /// All of the rectangle is seen, with a margin, from the yaw and tilt there are.
  void fit(const protocol::MapRect& rect);
  void look_down();  ///< Yaw and tilt 0.

  /// Where the eye is; map units.
  [[nodiscard]] Vec3 eye() const;
  /// From the eye to the target; map units. Nearer than a 64th of it nothing is drawn.
  [[nodiscard]] double distance() const;
  /// To clip space (x, y, z in -w .. w, y up), from positions relative to the target at height 0:
  /// so 32-bit floats do, far from 0 too. There is no far plane. With 24 bits, depths are told
  /// apart near the target that differ by 1/50 pixel, at any zoom, on screens of 2,000 pixels.
  [[nodiscard]] Mat4 clip_from_relative() const;
  /// The point of the plane at `height` that is seen there; none where that plane is not seen.
  [[nodiscard]] std::optional<protocol::MapPoint> ground(ScreenPoint at, double height = 0) const;
  /// Where the point is seen, perhaps outside the screen; none for what lies behind the eye or
  /// too near to be drawn.
  [[nodiscard]] std::optional<ScreenPoint> screen(const Vec3& point) const;
  /// The rectangle around all that is seen of the planes between `bottom` and `top`; the point
  /// below the eye when they are all above it.
  [[nodiscard]] protocol::MapRect seen(double bottom, double top) const;
  /// False only if nothing of the box can be seen; true, rarely, for one just beyond an edge of
  /// what is seen.
  [[nodiscard]] bool sees(const protocol::MapRect& rect, double bottom, double top) const;

 private:
  struct Axes;

  [[nodiscard]] Axes axes() const;
  [[nodiscard]] double focal() const;
  [[nodiscard]] double nearest() const;
  [[nodiscard]] Vec3 ray(ScreenPoint at) const;
  [[nodiscard]] std::optional<Vec3> hit(ScreenPoint at, double height) const;
  void clamp();

  ScreenSize size_;
  Place place_;
  double voxel_size_ = 1;
};

}  // namespace earthwork::scene
