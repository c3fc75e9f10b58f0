/// The mesh of one chunk of one layer: a surface at the layer's top and the walls' sections.
#pragma once

#include <cstdint>
#include <vector>

#include "server/voxel/crossing.hpp"

namespace earthwork::mesh {

/// A different triangulation leaves it as it is; a change in the order or merging of the wall
/// sections raises it, because mesh hashes then differ.
inline constexpr int kMesherVersion = 1;

inline constexpr std::uint16_t kNone = 0xFFFF;  ///< In place of a vertex: there is none.

/// A position in 1/32768 voxel from the chunk's origin (its lower-left corner, half a voxel to
/// the lower left of its first voxel): 16384 .. 64 * 32768 + 16384.
struct Point {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A wall from one surface vertex to the next, filled ground on the left of a -> b; it faces
/// right. The normals belong to its ends and are never against the section's own.
struct Section {
  std::uint16_t a = 0, b = 0;  ///< Indices into ChunkMesh::vertices.
  voxel::Normal normal_a, normal_b;
  friend bool operator==(const Section&, const Section&) = default;
};

/// Triangles are counter-clockwise seen from above, three indices each, none without area. The
/// surface's outline inside the chunk is exactly the sections. Sections come in chains: one
/// starts where the one before it ended, or begins a new contour.
struct ChunkMesh {
  std::vector<Point> vertices;
  std::vector<std::uint16_t> triangles;
  std::vector<Section> sections;

  bool empty() const { return triangles.empty() && sections.empty(); }
  void clear() { vertices.clear(), triangles.clear(), sections.clear(); }
  friend bool operator==(const ChunkMesh&, const ChunkMesh&) = default;
};

/// Twice the surface's area in squared position units: exact, and the same for every
/// triangulation of the same outline.
std::uint64_t twice_area(const ChunkMesh& mesh);

}  // namespace earthwork::mesh
