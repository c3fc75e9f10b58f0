/// The outline of a chunk's ground: its walls' sections, and the rim where it goes on next door.
#pragma once

#include <cstdint>
#include <vector>

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/contour_graph.hpp"

namespace earthwork::mesh {

/// Sets `next` for every point of `graph`: the point that follows it on an outline with the filled
/// ground on the left, or kNone. `sections` are the graph's walls. On the rim only crossings and
/// the chunk's corners are vertices, the same that the neighbours see; ears are left outside.
void link_outline(const ChunkCells& cells, const ContourGraph& graph,
                  const std::vector<Section>& sections, std::vector<std::uint16_t>& next);

}  // namespace earthwork::mesh
