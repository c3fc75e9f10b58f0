// GEOMETRY.md's stencil rules written down one voxel and one edge at a time, slow and plain: what
// the packed map is compared with.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "server/voxel/crossing.hpp"
#include "server/voxel/grid.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::voxel {

class ReferenceMap {
 public:
  using Voxel = std::pair<int, int>;
  using Edges = std::map<Voxel, Crossing>;  // by lower voxel

  explicit ReferenceMap(const Grid& grid) : grid_(grid) {}

  void apply(const Stencil& stencil) {
    const double r = stencil.radius, s = grid_.voxel_size;
    const int i0 = static_cast<int>(std::floor((stencil.x - r) / s)) - 2;
    const int i1 = static_cast<int>(std::ceil((stencil.x + r) / s)) + 2;
    const int j0 = static_cast<int>(std::floor((stencil.y - r) / s)) - 2;
    const int j1 = static_cast<int>(std::ceil((stencil.y + r) / s)) + 2;
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        if (!exists(i, j) || !covered(stencil, i, j)) continue;
        if (stencil.fill == Fill::filled) filled_.insert({i, j});
        if (stencil.fill == Fill::empty) filled_.erase({i, j});
      }
    }
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        edge(stencil, i, j, true);
        edge(stencil, i, j, false);
      }
    }
  }

  bool filled(int i, int j) const { return filled_.contains({i, j}); }
  const std::set<Voxel>& voxels() const { return filled_; }
  const Edges& edges(bool along_x) const { return along_x ? x_ : y_; }

 private:
  bool exists(int i, int j) const {
    const ChunkRect e = grid_.extent();
    const int r = grid_.resolution;
    return i >= e.x0 * r && i < e.x1 * r && j >= e.y0 * r && j < e.y1 * r;
  }
  double at(int i) const { return (i + 0.5) * grid_.voxel_size; }
  bool covered(const Stencil& stencil, int i, int j) const {
    const double dx = at(i) - stencil.x, dy = at(j) - stencil.y, r = stencil.radius;
    if (stencil.shape == Shape::square) return std::fabs(dx) <= r && std::fabs(dy) <= r;
    return dx * dx + dy * dy <= r * r;
  }

  void edge(const Stencil& stencil, int i, int j, bool along_x) {
    const int i2 = along_x ? i + 1 : i, j2 = along_x ? j : j + 1;
    if (!exists(i, j) || !exists(i2, j2)) return;
    Edges& edges = along_x ? x_ : y_;
    const bool low = filled(i, j), high = filled(i2, j2);
    if (low == high) {
      edges.erase({i, j});
      return;
    }
    const bool fill = stencil.fill == Fill::filled;
    const bool v_low = low == fill;
    if (!(v_low ? covered(stencil, i, j) : covered(stencil, i2, j2))) return;
    const Crossing fresh = cut(stencil, i, j, along_x, v_low);
    const auto found = edges.find({i, j});
    const bool further = found == edges.end() || (v_low ? fresh.offset > found->second.offset
                                                        : fresh.offset < found->second.offset);
    if (further) edges[{i, j}] = fresh;
  }

  Crossing cut(const Stencil& stencil, int i, int j, bool along_x, bool v_low) const {
    const double r = stencil.radius;
    const double centre = along_x ? stencil.x : stencil.y;
    const double d = along_x ? at(j) - stencil.y : at(i) - stencil.x;
    const bool circle = stencil.shape == Shape::circle;
    const double h = circle ? std::sqrt(r * r - d * d) : r;
    const double p0 = at(along_x ? i : j);
    const double steps =
        std::floor(((v_low ? centre + h : centre - h) - p0) / grid_.voxel_size * 32768 + 0.5);
    const double offset = std::fmin(std::fmax(steps, 1), 32767);
    double along = 32767, across = 0;
    if (circle && r > 0) {
      along = std::round((32767 * h) / r);
      across = std::round((32767 * d) / r);
    }
    if (!v_low) along = -along;
    if (stencil.fill == Fill::empty) along = -along, across = -across;
    const auto a = static_cast<std::int16_t>(along), c = static_cast<std::int16_t>(across);
    return {static_cast<std::uint16_t>(offset), along_x ? Normal{a, c} : Normal{c, a}};
  }

  Grid grid_;
  std::set<Voxel> filled_;
  Edges x_, y_;
};

}  // namespace earthwork::voxel
