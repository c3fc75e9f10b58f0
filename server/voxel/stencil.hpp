/// A stencil: the shape that an edit stamps on a layer, filling or emptying what it covers.
#pragma once

#include <cstdint>

namespace earthwork::voxel {

enum class Shape : std::uint8_t { square, circle };
enum class Fill : std::uint8_t { empty, filled };

/// A shape around a centre, in map units. All three numbers are finite and radius >= 0; the
/// outline itself is covered. A square has its sides at radius from the centre.
struct Stencil {
  double x = 0, y = 0;
  double radius = 0;
  Shape shape = Shape::circle;
  Fill fill = Fill::filled;
};

}  // namespace earthwork::voxel
