#include "tests/bench/map_mesh.hpp"

#include <thread>

namespace earthwork::bench {

MapMesh::MapMesh(const MapSize& size)
    : size_(size), meshes_(static_cast<std::size_t>(size.chunks_x * size.chunks_y)) {
  meshers_.emplace_back(kFeatureAngle);
}

void MapMesh::mesh_chunk(const voxel::Map& map, mesh::Mesher& mesher, std::size_t index) {
  const int i = static_cast<int>(index);
  const voxel::ChunkKey key{0, i % size_.chunks_x, i / size_.chunks_x, 0};
  mesher.mesh(map.neighbourhood(key), kBenchResolution, meshes_[index]);
}

void MapMesh::mesh_all(const voxel::Map& map, int threads) {
  while (meshers_.size() < static_cast<std::size_t>(threads)) meshers_.emplace_back(kFeatureAngle);
  const auto share = [&](std::size_t thread) {
    for (std::size_t i = thread; i < meshes_.size(); i += static_cast<std::size_t>(threads)) {
      mesh_chunk(map, meshers_[thread], i);
    }
  };
  std::vector<std::jthread> others;
  for (int k = 1; k < threads; ++k) others.emplace_back(share, static_cast<std::size_t>(k));
  share(0);
}

void MapMesh::mesh_dirty(const voxel::Map& map, const voxel::Change& change) {
  for (const voxel::DirtyChunk& dirty : change.dirty) {
    mesh_chunk(map, meshers_[0],
               static_cast<std::size_t>(dirty.key.y * size_.chunks_x + dirty.key.x));
  }
}

std::vector<std::pair<std::string, double>> MapMesh::figures() const {
  double vertices = 0, triangles = 0, sections = 0, twice_area = 0, bytes = 0;
  for (const mesh::ChunkMesh& mesh : meshes_) {
    vertices += static_cast<double>(mesh.vertices.size());
    triangles += static_cast<double>(mesh.triangles.size() / 3);
    sections += static_cast<double>(mesh.sections.size());
    twice_area += static_cast<double>(mesh::twice_area(mesh));
    bytes += static_cast<double>(mesh.vertices.capacity() * sizeof(mesh::Point) +
                                 mesh.triangles.capacity() * sizeof(std::uint16_t) +
                                 mesh.sections.capacity() * sizeof(mesh::Section) + sizeof mesh);
  }
  const double area = twice_area / 2 / voxel::kEdgeSteps / voxel::kEdgeSteps;
  return {{"vertices", vertices},
          {"triangles", triangles},
          {"sections", sections},
          {"area", area},
          {"mesh_bytes", bytes}};
}

}  // namespace earthwork::bench
