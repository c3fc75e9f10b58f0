#include "client/scene/brush.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace earthwork::scene {

using protocol::MapPoint;

namespace {

constexpr std::size_t kMinCirclePoints = 16, kMaxCirclePoints = 256;

/// A chord of an n-gon strays from its circle by r (1 - cos(pi / n)).
std::size_t circle_points(double radius, double tolerance) {
  if (!(tolerance > 0)) return kMaxCirclePoints;
  if (tolerance >= radius) return kMinCirclePoints;
  const double points = std::ceil(std::numbers::pi / std::acos(1 - tolerance / radius));
  // Written so that a tolerance too small for 1 - t / r, an infinity here, means the most.
  if (!(points < static_cast<double>(kMaxCirclePoints))) return kMaxCirclePoints;
  return std::max(kMinCirclePoints, static_cast<std::size_t>(points));
}

}  // namespace

Snap snap_of(const BrushSettings& brush) {
  return brush.radius_voxels < 0.5 ? Snap::centres : brush.snap;
}

MapPoint snapped(MapPoint at, Snap snap, double voxel_size) {
  const auto place = [&](double map_units) {
    const double voxels = map_units / voxel_size;
    if (snap == Snap::centres) return (std::floor(voxels) + 0.5) * voxel_size;
    return std::floor(voxels + 0.5) * voxel_size;
  };
  return snap == Snap::none ? at : MapPoint{place(at.x), place(at.y)};
}

std::vector<MapPoint> outline(protocol::StencilShape stencil, double radius, MapPoint centre,
                              double tolerance) {
  if (!(radius > 0)) return {};
  const auto [x, y] = centre;
  if (stencil == protocol::StencilShape::square)
    return {{x - radius, y - radius},
            {x + radius, y - radius},
            {x + radius, y + radius},
            {x - radius, y + radius}};
  std::vector<MapPoint> points(circle_points(radius, tolerance));
  const double step = 2 * std::numbers::pi / static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double angle = step * static_cast<double>(i);
    points[i] = {x + radius * std::cos(angle), y + radius * std::sin(angle)};
  }
  return points;
}

}  // namespace earthwork::scene
