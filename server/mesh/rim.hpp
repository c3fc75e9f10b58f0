/// The rim of a chunk: the square of voxel lines around its cells, and what lies on it.
#pragma once

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/contour_graph.hpp"

namespace earthwork::mesh {

/// Goes around the rim counter-clockwise from the lower left, and calls corner(k) at the corners,
/// k = 0 .. 3, and crossing(point) at the crossings between them.
template <class Corner, class Crossing>
void walk_rim(const ChunkCells& cells, Corner&& corner, Crossing&& crossing) {
  const int height = cells.height();
  corner(0);
  for (int id = cells.x_start(0); id < cells.x_start(1); ++id) {
    crossing(static_cast<std::uint16_t>(id));
  }
  corner(1);
  for (int y = 0; y < height; ++y) {
    const int last = cells.y_start(y + 1) - cells.y_start(y) - 1;
    if (cells.last_column(y)) crossing(ContourGraph::y_id(cells, y, last));
  }
  corner(2);
  for (int id = cells.x_start(height + 1) - 1; id >= cells.x_start(height); --id) {
    crossing(static_cast<std::uint16_t>(id));
  }
  corner(3);
  for (int y = height - 1; y >= 0; --y) {
    if ((cells.y_mask(y) & 1) != 0) crossing(ContourGraph::y_id(cells, y, 0));
  }
}

}  // namespace earthwork::mesh
