/// A chunk's contour as a graph: the crossings and features as points, and the pieces that lead
/// from one crossing to the next through a cell.
#pragma once

#include <cstdint>
#include <vector>

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/chunk_mesh.hpp"

namespace earthwork::mesh {

/// Points are numbered: x crossings, y crossings, then the chunk's corners and the features.
///
/// Reusable; the vectors are read by the steps that follow, which also drop points.
struct ContourGraph {
  /// An outward corner of a cell whose two filled corners stay apart. The tips of the two may
  /// overlap, so a tip is a triangle of its own and the outline passes below it.
  struct Ear {
    std::uint16_t from, tip, to;
  };

  std::vector<Point> points;
  std::vector<voxel::Normal> normals;  ///< Of crossings only.
  std::vector<std::uint16_t> to;       ///< The crossing a crossing's piece leads to, or kNone.
  std::vector<std::uint16_t> feature;  ///< The feature in between, or kNone.
  std::vector<std::uint8_t> fixed;     ///< Must stay a vertex, however straight the contour.
  std::vector<std::uint16_t> order;    ///< All points by y and then x.
  std::vector<Ear> ears;
  std::uint16_t corners[4];  ///< Lower left, lower right, upper right, upper left;
                             ///< kNone when that voxel is empty.

  /// `limit` as in `contour`.
  void build(const ChunkCells& cells, std::int64_t limit);

  static std::uint16_t x_id(const ChunkCells& cells, int y, int index) {
    return static_cast<std::uint16_t>(cells.x_start(y) + index);
  }
  static std::uint16_t y_id(const ChunkCells& cells, int y, int index) {
    return static_cast<std::uint16_t>(cells.x_count() + cells.y_start(y) + index);
  }

 private:
  void place_crossings(const ChunkCells& cells);
  void place_corners(const ChunkCells& cells);
  void add_cell(const ChunkCells& cells, const MixedCell& cell, std::int64_t limit);
  void order_row(const ChunkCells& cells, int y);
  void order_band(const ChunkCells& cells, int y, std::size_t first_feature);
  std::uint16_t add_point(Point point);

  std::vector<std::uint64_t> keys_;
};

}  // namespace earthwork::mesh
