// All that is measured is measured from the target, so that the error at a million voxels from 0 is
// that of a coordinate and not of a difference of large products.
#include "client/scene/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/limits.hpp"

namespace earthwork::scene {

using protocol::MapPoint;
using protocol::MapRect;

/// Unit vectors of the screen in map space. `forward` leads away from the eye.
struct Camera::Axes {
  Vec3 right, up, forward;
};

namespace {

constexpr double kHalfFieldOfView = 15 * std::numbers::pi / 180;
constexpr double kMaxScreen = 65536;    // CSS pixels
constexpr double kMinZoomVoxels = 4e6;  // on the shorter side of the screen
constexpr double kMaxPixelsPerVoxel = 400;
constexpr double kNearestShare = 1.0 / 64;  // of the distance to the target
constexpr double kFitMarginShare = 0.05;    // of the shorter side, on every side
/// In the upper corners of a picture at the largest tilt the ground is 29 times as far as the
/// target; what is further is beyond the screen.
constexpr double kMaxPanDepthShare = 32;

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator*(const Vec3& a, double k) { return {a.x * k, a.y * k, a.z * k}; }
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void keep_finite(double& value, double wanted) {
  if (std::isfinite(wanted)) value = wanted;
}

}  // namespace

void Camera::set_voxel_size(double voxel_size) {
  if (std::isfinite(voxel_size) && voxel_size > 0) voxel_size_ = voxel_size;
  clamp();
}

void Camera::resize(ScreenSize size) {
  keep_finite(size_.width, size.width);
  keep_finite(size_.height, size.height);
  clamp();
}

void Camera::set(const Place& place) {
  keep_finite(place_.target.x, place.target.x);
  keep_finite(place_.target.y, place.target.y);
  keep_finite(place_.zoom, place.zoom);
  keep_finite(place_.yaw, place.yaw);
  keep_finite(place_.tilt, place.tilt);
  clamp();
}

void Camera::clamp() {
  size_.width = std::clamp(size_.width, 1.0, kMaxScreen);
  size_.height = std::clamp(size_.height, 1.0, kMaxScreen);
  const double world = protocol::kWorldVoxels * voxel_size_;
  place_.target.x = std::clamp(place_.target.x, -world, world);
  place_.target.y = std::clamp(place_.target.y, -world, world);
  const double shorter = std::min(size_.width, size_.height);
  place_.zoom = std::clamp(place_.zoom, shorter / (kMinZoomVoxels * voxel_size_),
                           kMaxPixelsPerVoxel / voxel_size_);
  place_.yaw = std::remainder(place_.yaw, 2 * std::numbers::pi);
  place_.tilt = std::clamp(place_.tilt, 0.0, kMaxTilt);
}

void Camera::pan(ScreenPoint from, ScreenPoint to) {
  const std::optional<Vec3> grabbed = hit(from, 0), under = hit(to, 0);
  if (!grabbed || !under) return;
  const double furthest = kMaxPanDepthShare * distance();
  const Vec3 forward = axes().forward;
  const auto too_far = [&](const Vec3& at) { return distance() + dot(forward, at) > furthest; };
  if (too_far(*grabbed) || too_far(*under)) return;
  place_.target.x += grabbed->x - under->x;
  place_.target.y += grabbed->y - under->y;
  clamp();
}

void Camera::zoom_at(ScreenPoint at, double factor) {
  if (!(std::isfinite(factor) && factor > 0)) return;
  const Vec3 held = hit(at, 0).value_or(Vec3{});
  const double before = place_.zoom;
  place_.zoom *= factor;
  clamp();
  // What is seen from the target's side shrinks in proportion, so what is held does as well.
  const double moved = 1 - before / place_.zoom;
  place_.target.x += held.x * moved;
  place_.target.y += held.y * moved;
  clamp();
}

void Camera::orbit(double yaw, double tilt) {
  Place turned = place_;
  turned.yaw += yaw;
  turned.tilt += tilt;
  set(turned);
}

// Each side of the picture, drawn in by the margin, is a plane through the eye that all corners are
// to lie within. Opposite sides together say how far back the eye has to be; of the two pairs the
// larger distance counts, and between the sides of the other pair the eye stands in the middle.
void Camera::fit(const MapRect& rect) {
  const MapPoint middle{rect.x0 + (rect.x1 - rect.x0) / 2, rect.y0 + (rect.y1 - rect.y0) / 2};
  const double half_width = (rect.x1 - rect.x0) / 2, half_height = (rect.y1 - rect.y0) / 2;
  const double margin = kFitMarginShare * std::min(size_.width, size_.height);
  const double across = (size_.width / 2 - margin) / focal();
  const double upward = (size_.height / 2 - margin) / focal();
  if (!std::isfinite(middle.x + middle.y + half_width + half_height)) return;

  const Axes a = axes();
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  double right = kNone, left = kNone, top = kNone, bottom = kNone;
  for (const double x : {-half_width, half_width})
    for (const double y : {-half_height, half_height}) {
      const Vec3 corner{x, y, 0};
      const double depth = dot(a.forward, corner);
      right = std::max(right, dot(a.right, corner) - across * depth);
      left = std::max(left, -dot(a.right, corner) - across * depth);
      top = std::max(top, dot(a.up, corner) - upward * depth);
      bottom = std::max(bottom, -dot(a.up, corner) - upward * depth);
    }
  const double back = std::max((right + left) / (2 * across), (top + bottom) / (2 * upward));
  const Vec3 eye = a.right * ((right - left) / 2) + a.up * ((top - bottom) / 2) + a.forward * -back;
  const double away = std::max(eye.z / -a.forward.z, 0.0);
  const Vec3 target = eye + a.forward * away;
  // Of a single point the distance is 0; the nearest there is is taken then.
  place_.zoom = std::min(focal() / away, std::numeric_limits<double>::max());
  place_.target = {middle.x + target.x, middle.y + target.y};
  clamp();
}

void Camera::look_down() { place_.yaw = place_.tilt = 0; }

Camera::Axes Camera::axes() const {
  const double cy = std::cos(place_.yaw), sy = std::sin(place_.yaw);
  const double ct = std::cos(place_.tilt), st = std::sin(place_.tilt);
  return {.right = {cy, sy, 0}, .up = {-sy * ct, cy * ct, st}, .forward = {-sy * st, cy * st, -ct}};
}

/// How far the eye is from the screen, in CSS pixels.
double Camera::focal() const { return size_.height / 2 / std::tan(kHalfFieldOfView); }

double Camera::distance() const { return focal() / place_.zoom; }

double Camera::nearest() const { return distance() * kNearestShare; }

Vec3 Camera::eye() const {
  const Vec3 relative = axes().forward * -distance();
  return Vec3{place_.target.x, place_.target.y, 0} + relative;
}

// A point p is seen at (right.p, up.p) at the depth distance + forward.p. Without a far plane z is
// depth - 2 nearest, so z / w runs from -1 at the nearest depth toward 1.
Mat4 Camera::clip_from_relative() const {
  const Axes a = axes();
  const double x = focal() / (size_.width / 2), y = focal() / (size_.height / 2);
  const Vec3& f = a.forward;
  return {.m = {x * a.right.x, y * a.up.x, f.x, f.x,  //
                x * a.right.y, y * a.up.y, f.y, f.y,  //
                x * a.right.z, y * a.up.z, f.z, f.z,  //
                0, 0, distance() - 2 * nearest(), distance()}};
}

/// From the eye to the screen, which is `focal` pixels away: a multiple is a point seen at `at`.
Vec3 Camera::ray(ScreenPoint at) const {
  const Axes a = axes();
  return a.right * (at.x - size_.width / 2) + a.up * (size_.height / 2 - at.y) +
         a.forward * focal();
}

/// The point at that height that is seen at `at`, relative to the target.
std::optional<Vec3> Camera::hit(ScreenPoint at, double height) const {
  const Vec3 from = axes().forward * -distance();
  const Vec3 direction = ray(at);
  const double times = (height - from.z) / direction.z;
  if (!(times * focal() >= nearest())) return std::nullopt;
  const Vec3 point = from + direction * times;
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) return std::nullopt;
  return point;
}

std::optional<MapPoint> Camera::ground(ScreenPoint at, double height) const {
  const std::optional<Vec3> point = hit(at, height);
  if (!point) return std::nullopt;
  return MapPoint{place_.target.x + point->x, place_.target.y + point->y};
}

std::optional<ScreenPoint> Camera::screen(const Vec3& point) const {
  const Axes a = axes();
  const Vec3 relative{point.x - place_.target.x, point.y - place_.target.y, point.z};
  const double depth = distance() + dot(a.forward, relative);
  if (!(depth >= nearest())) return std::nullopt;
  const double scale = focal() / depth;
  return ScreenPoint{size_.width / 2 + dot(a.right, relative) * scale,
                     size_.height / 2 - dot(a.up, relative) * scale};
}

// What is seen of a height is a convex figure between the rays of the picture's corners, all of
// which lead downward; from the lowest height to the highest its corners move along these rays.
MapRect Camera::seen(double bottom, double top) const {
  const Vec3 from = axes().forward * -distance();
  MapRect around{from.x, from.y, from.x, from.y};
  bool first = true;
  for (const double x : {0.0, size_.width})
    for (const double y : {0.0, size_.height}) {
      const Vec3 direction = ray({x, y});
      for (const double height : {bottom, top}) {
        const double times = std::max((height - from.z) / direction.z, 0.0);
        const Vec3 at = from + direction * times;
        around = first ? MapRect{at.x, at.y, at.x, at.y}
                       : MapRect{std::min(around.x0, at.x), std::min(around.y0, at.y),
                                 std::max(around.x1, at.x), std::max(around.y1, at.y)};
        first = false;
      }
    }
  const auto [x, y] = place_.target;
  const double rounding = 1e-9 * distance() + 1e-15 * std::max(std::abs(x), std::abs(y));
  return {x + around.x0 - rounding, y + around.y0 - rounding, x + around.x1 + rounding,
          y + around.y1 + rounding};
}

// Nothing is seen of a box that lies outside one side of the picture, or beside all that is seen
// of its heights.
bool Camera::sees(const MapRect& rect, double bottom, double top) const {
  const Axes a = axes();
  const double across = size_.width / 2 / focal(), upward = size_.height / 2 / focal();
  const double rounding = 1e-9 * distance();
  bool left = true, right = true, below = true, above = true, behind = true;
  for (const double x : {rect.x0, rect.x1})
    for (const double y : {rect.y0, rect.y1})
      for (const double z : {bottom, top}) {
        const Vec3 corner{x - place_.target.x, y - place_.target.y, z};
        const double to_right = dot(a.right, corner), to_top = dot(a.up, corner);
        const double depth = distance() + dot(a.forward, corner);
        left = left && to_right < -across * depth - rounding;
        right = right && to_right > across * depth + rounding;
        below = below && to_top < -upward * depth - rounding;
        above = above && to_top > upward * depth + rounding;
        behind = behind && depth < nearest() - rounding;
      }
  if (left || right || below || above || behind || bottom > eye().z) return false;
  const MapRect all = seen(bottom, top);
  return rect.x0 <= all.x1 && rect.x1 >= all.x0 && rect.y0 <= all.y1 && rect.y1 >= all.y0;
}

}  // namespace earthwork::scene
