/// What a person paints with, and the outline of the next stamp.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/edit.hpp"

namespace earthwork::scene {

enum class Snap : std::uint8_t {
  none,
  centres,  ///< To the nearest voxel.
  lines,    ///< To the nearest corner between four voxels.
};

inline constexpr double kMaxBrushVoxels = 50;

struct BrushSettings {
  protocol::StencilShape stencil = protocol::StencilShape::circle;
  bool fill = true;
  double radius_voxels = 3;  ///< 0 .. kMaxBrushVoxels.
  std::uint32_t layer = 0;
  Snap snap = Snap::none;
  friend bool operator==(const BrushSettings&, const BrushSettings&) = default;
};

/// How the brush snaps: a radius below half a voxel, which could slip between the voxels and paint
/// nothing, always goes to centres.
[[nodiscard]] Snap snap_of(const BrushSettings& brush);

/// Where a stamp that is aimed at `at` is made.
[[nodiscard]] protocol::MapPoint snapped(protocol::MapPoint at, Snap snap, double voxel_size);

/// The stencil's edge when stamped at `centre`, as it will be applied: a closed polygon,
/// counter-clockwise, without its first point twice. A circle's chords stray from it by no more
/// than `tolerance` map units, within 16 .. 256 points; of radius 0 there are no points.
[[nodiscard]] std::vector<protocol::MapPoint> outline(protocol::StencilShape stencil, double radius,
                                                      protocol::MapPoint centre, double tolerance);

}  // namespace earthwork::scene
