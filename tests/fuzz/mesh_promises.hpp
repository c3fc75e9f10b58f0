/// What every mesh that was decoded keeps, wherever its bytes came from.
#pragma once

#include <cstdint>

#include "protocol/chunk_record.hpp"
#include "protocol/limits.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {

inline void check_promises(const ChunkMesh& mesh) {
  expect(mesh.vertices.size() <= kMaxVertices, "count of vertices");
  for (const MeshPoint& vertex : mesh.vertices)
    expect(vertex.x >= 0 && vertex.x < kMeshCoordinateEnd && vertex.y >= 0 &&
               vertex.y < kMeshCoordinateEnd,
           "coordinates");
  expect(mesh.triangles.size() % 3 == 0, "three indices a triangle");
  for (const std::uint16_t index : mesh.triangles)
    expect(index < mesh.vertices.size(), "triangle indices");
  for (const WallSection& section : mesh.sections)
    expect(section.a < mesh.vertices.size() && section.b < mesh.vertices.size() &&
               section.a != section.b,
           "section indices");
}

}  // namespace earthwork::protocol
