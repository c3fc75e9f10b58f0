// Edits for the properties: few enough places and sizes that shapes meet, touch and coincide.
#pragma once

#include <rapidcheck/gtest.h>

#include <ostream>
#include <vector>

#include "server/voxel/map.hpp"

namespace earthwork::voxel {

inline void showValue(const Stencil& s, std::ostream& os) {
  os << (s.fill == Fill::filled ? "fill " : "empty ")
     << (s.shape == Shape::square ? "square " : "circle ") << s.x << ' ' << s.y << " r "
     << s.radius;
}

/// Centres within `reach` voxels of the origin, on a lattice of 1/2 or 1/16 voxel, or anywhere.
inline rc::Gen<Stencil> any_stencil(int reach, double voxel_size = 1) {
  return rc::gen::exec([=] {
    const auto coordinate = [&] {
      switch (*rc::gen::weightedElement<int>({{4, 2}, {4, 16}, {1, 0}})) {
        case 2:
          return *rc::gen::inRange(-2 * reach, 2 * reach + 1) / 2.0;
        case 16:
          return *rc::gen::inRange(-16 * reach, 16 * reach + 1) / 16.0;
        default:
          return *rc::gen::inRange(-1000003 * reach, 1000003 * reach) / 1000003.0;
      }
    };
    Stencil s;
    s.x = coordinate() * voxel_size, s.y = coordinate() * voxel_size;
    const int halves = *rc::gen::inRange(0, 12);
    s.radius =
        *rc::gen::element(halves / 2.0, halves / 2.0, halves / 16.0, halves + 0.25) * voxel_size;
    s.shape = *rc::gen::element(Shape::square, Shape::circle);
    s.fill = *rc::gen::weightedElement<Fill>({{3, Fill::filled}, {2, Fill::empty}});
    return s;
  });
}

inline rc::Gen<std::vector<Stencil>> any_edits(int reach, double voxel_size = 1) {
  return rc::gen::scale(0.4,
                        rc::gen::container<std::vector<Stencil>>(any_stencil(reach, voxel_size)));
}

inline rc::Gen<int> any_resolution() { return rc::gen::element(8, 16, 32, 64); }

/// Unbounded, or a few chunks around the origin.
inline rc::Gen<Grid> any_grid() {
  return rc::gen::exec([] {
    Grid grid{.resolution = *any_resolution(), .bounds = {}};
    if (*rc::gen::arbitrary<bool>()) {
      grid.bounds = ChunkRect{*rc::gen::inRange(-2, 1), *rc::gen::inRange(-2, 1),
                              *rc::gen::inRange(1, 3), *rc::gen::inRange(1, 3)};
    }
    return grid;
  });
}

inline void showValue(const Grid& g, std::ostream& os) {
  os << "R " << g.resolution;
  if (g.bounds) {
    os << " [" << g.bounds->x0 << ' ' << g.bounds->y0 << ' ' << g.bounds->x1 << ' ' << g.bounds->y1
       << ']';
  }
}

}  // namespace earthwork::voxel
