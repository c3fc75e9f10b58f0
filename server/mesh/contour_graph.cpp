#include "server/mesh/contour_graph.hpp"

#include <algorithm>

namespace earthwork::mesh {
namespace {

constexpr std::int32_t kStep = voxel::kEdgeSteps;

/// The position of voxel (x, y) of the chunk.
Point voxel_point(int x, int y) { return {kStep / 2 + x * kStep, kStep / 2 + y * kStep}; }

/// A left turn at `tip`: filled ground, which is on the left, has a corner there.
bool outward(Point from, Point tip, Point to) {
  const std::int64_t ax = tip.x - from.x, ay = tip.y - from.y, bx = to.x - tip.x, by = to.y - tip.y;
  return ax * by - ay * bx > 0;
}

}  // namespace

void ContourGraph::build(const ChunkCells& cells, std::int64_t limit) {
  const auto count = static_cast<std::size_t>(cells.x_count() + cells.y_count());
  points.resize(count), normals.resize(count);
  to.assign(count, kNone), feature.assign(count, kNone);
  fixed.assign(count, 0);
  order.clear(), ears.clear();
  place_crossings(cells);
  place_corners(cells);
  for (int y = 0; y < cells.height(); ++y) {
    const std::size_t first_feature = points.size();
    if (cells.mixed(y) != 0) {
      cells.walk_row(y, [&](const MixedCell& cell) { add_cell(cells, cell, limit); });
    }
    order_row(cells, y);
    order_band(cells, y, first_feature);
  }
  order_row(cells, cells.height());
}

void ContourGraph::place_crossings(const ChunkCells& cells) {
  std::size_t id = 0;
  for (int y = 0; y <= cells.height(); ++y) {
    const voxel::Crossing* crossing = cells.x_row(y);
    for (std::uint64_t left = cells.x_mask(y); left != 0; left &= left - 1, ++id, ++crossing) {
      const Point at = voxel_point(std::countr_zero(left), y);
      points[id] = {at.x + crossing->offset, at.y};
      normals[id] = crossing->normal;
    }
  }
  for (int y = 0; y < cells.height(); ++y) {
    const voxel::Crossing* crossing = cells.y_row(y);
    const auto add = [&](int x) {
      const Point at = voxel_point(x, y);
      points[id] = {at.x, at.y + crossing->offset};
      normals[id++] = crossing++->normal;
    };
    for (std::uint64_t left = cells.y_mask(y); left != 0; left &= left - 1) {
      add(std::countr_zero(left));
    }
    if (cells.last_column(y)) add(cells.width());
  }
}

void ContourGraph::place_corners(const ChunkCells& cells) {
  const int w = cells.width(), h = cells.height();
  const int at[4][2] = {{0, 0}, {w, 0}, {w, h}, {0, h}};
  for (int k = 0; k < 4; ++k) {
    const auto [x, y] = at[k];
    corners[k] = cells.filled(x, y) ? add_point(voxel_point(x, y)) : kNone;
  }
}

std::uint16_t ContourGraph::add_point(Point point) {
  points.push_back(point);
  return static_cast<std::uint16_t>(points.size() - 1);
}

void ContourGraph::add_cell(const ChunkCells& cells, const MixedCell& cell, std::int64_t limit) {
  const CellContour pieces = contour(cell.cell_case, cells.hits(cell), limit);
  const auto id = [&](Side side) {
    const int index = cell.index[side];
    return side == kBottom ? x_id(cells, cell.y, index)
           : side == kTop  ? x_id(cells, cell.y + 1, index)
                           : y_id(cells, cell.y, index);
  };
  for (int k = 0; k < pieces.count; ++k) {
    const Piece& piece = pieces.pieces[static_cast<std::size_t>(k)];
    const std::uint16_t from = id(piece.from), target = id(piece.to);
    to[from] = target;
    if (!piece.feature) continue;
    const Point corner = voxel_point(cell.x, cell.y);
    const std::uint16_t tip = add_point({corner.x + static_cast<std::int32_t>(piece.feature->x),
                                         corner.y + static_cast<std::int32_t>(piece.feature->y)});
    feature[from] = tip;
    const bool apart = pieces.count == 2 && !pieces.connected;
    if (apart && outward(points[from], points[tip], points[target])) {
      ears.push_back({from, tip, target});
      fixed[from] = fixed[target] = 1;
    }
  }
}

// The crossings on a voxel row are in order as they are; a corner lies outside of them.
void ContourGraph::order_row(const ChunkCells& cells, int y) {
  const bool bottom = y == 0, top = y == cells.height();
  const auto add_corner = [&](std::uint16_t corner) {
    if (corner != kNone) order.push_back(corner);
  };
  if (bottom || top) add_corner(corners[bottom ? 0 : 3]);
  for (int id = cells.x_start(y); id < cells.x_start(y + 1); ++id) {
    order.push_back(static_cast<std::uint16_t>(id));
  }
  if (bottom || top) add_corner(corners[bottom ? 1 : 2]);
}

// What lies between two voxel rows comes by columns and is sorted.
void ContourGraph::order_band(const ChunkCells& cells, int y, std::size_t first_feature) {
  keys_.clear();
  const auto add = [&](std::size_t id) {
    const Point p = points[id];
    keys_.push_back(static_cast<std::uint64_t>(p.y) << 40 | static_cast<std::uint64_t>(p.x) << 16 |
                    id);
  };
  const auto base = static_cast<std::size_t>(cells.x_count());
  for (int k = cells.y_start(y); k < cells.y_start(y + 1); ++k) {
    add(base + static_cast<std::size_t>(k));
  }
  for (std::size_t id = first_feature; id < points.size(); ++id) add(id);
  if (keys_.size() > 1) std::sort(keys_.begin(), keys_.end());
  for (const std::uint64_t key : keys_) order.push_back(static_cast<std::uint16_t>(key));
}

}  // namespace earthwork::mesh
