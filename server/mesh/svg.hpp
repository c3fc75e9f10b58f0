/// Contours as pictures: what a golden file shows to a person.
#pragma once

#include <string>

#include "server/voxel/map.hpp"

namespace earthwork::mesh {

/// An SVG document of one layer: the surface's triangles, the walls' sections with the normals of
/// their ends, the chunks' rims. 64 user units a voxel, y up. The same map gives the same text.
std::string contour_svg(const voxel::Map& map, int layer, double max_feature_angle);

}  // namespace earthwork::mesh
