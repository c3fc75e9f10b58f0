/// The outlines of a map's chunks as the triangulation gets them.
#pragma once

#include <cstdint>
#include <vector>

#include "server/mesh/chunk_mesh.hpp"
#include "server/voxel/map.hpp"
#include "tests/bench/field_map.hpp"

namespace earthwork::bench {

/// What mesh::Triangulator::run takes.
struct Outline {
  std::vector<mesh::Point> points;
  std::vector<std::uint16_t> next;
  /// Points that are on an outline.
  std::size_t vertices() const;
};

/// Of every chunk with filled and empty ground, row by row.
std::vector<Outline> make_outlines(const voxel::Map& map, const MapSize& size);

}  // namespace earthwork::bench
