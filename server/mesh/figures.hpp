/// Figures of a map's geometry, counted over its cells: what conformance is checked against.
#pragma once

#include <array>
#include <cstdint>

#include "server/voxel/map.hpp"

namespace earthwork::mesh {

/// Lengths in map units. Counted over all layers.
struct Figures {
  double surface_area = 0;                     ///< Sum of the cells' polygons.
  double wall_length = 0;                      ///< Along the sections, through features.
  std::uint64_t wall_sections = 0;             ///< Before merging; one with a feature is two.
  std::uint64_t degenerate_wall_sections = 0;  ///< Without length; there are none.
  std::uint64_t sharp_features = 0;            ///< In the final contour.
  std::uint64_t clamped_features = 0;          ///< Of one-corner shapes, strictly beyond a side.
  std::uint64_t diagonal_connections = 0;
  std::array<std::uint64_t, 16> cells_by_case{};  ///< All cells of the bounds; without bounds, of
                                                  ///< the chunks that may have a mesh.
  std::uint64_t filled_voxels = 0;
};

Figures count_figures(const voxel::Map& map, double max_feature_angle);

}  // namespace earthwork::mesh
