/// How one picture is looked at, in numbers that 32-bit floats hold: positions count from a voxel
/// near what is looked at.
#pragma once

#include <array>

#include "client/viewer/picture.hpp"

namespace earthwork::viewer::render {

struct Projection {
  /// The voxel corner nearest to the camera's target: positions in shaders are voxels from here.
  /// Whole numbers, so the vertices of two batches that are one point stay one: both sums are
  /// rounded from the same value.
  double origin_x = 0, origin_y = 0;
  double voxel_size = 1;
  /// From (voxels from the origin, voxels from the origin, height in map units) to clip space.
  std::array<float, 16> clip_from_voxels{};
  int width = 1, height = 1;  ///< Pixels of the picture.
  double pixel_ratio = 1;
};

[[nodiscard]] Projection projection_of(const Picture& picture);

/// Nearer to the eye than its place by this much of the depth range for each layer, the lowest
/// first: surfaces of two layers that share a plane hide each other in order, not in flickering
/// bits. Far above the error of interpolated depths, far below what is seen.
inline constexpr float kLayerBias = 1.0F / (1 << 19);

}  // namespace earthwork::viewer::render
