#include "server/mesh/chunk_mesh.hpp"

namespace earthwork::mesh {

std::uint64_t twice_area(const ChunkMesh& mesh) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k + 2 < mesh.triangles.size(); k += 3) {
    const Point a = mesh.vertices[mesh.triangles[k]], b = mesh.vertices[mesh.triangles[k + 1]],
                c = mesh.vertices[mesh.triangles[k + 2]];
    sum += std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
  }
  return static_cast<std::uint64_t>(sum);
}

}  // namespace earthwork::mesh
