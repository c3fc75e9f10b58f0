/// All meshes of a map made from a field, kept between re-meshings as a server keeps them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/mesh/chunk_mesh.hpp"
#include "server/mesh/mesher.hpp"
#include "server/voxel/map.hpp"
#include "tests/bench/field_map.hpp"

namespace earthwork::bench {

inline constexpr double kFeatureAngle = 135;

class MapMesh {
 public:
  explicit MapMesh(const MapSize& size);

  /// Meshes every chunk, each thread (1 .. 64) a share of them with a mesher of its own. Nobody
  /// changes the map meanwhile.
  void mesh_all(const voxel::Map& map, int threads);
  /// Meshes the chunks that an edit left to be meshed again.
  void mesh_dirty(const voxel::Map& map, const voxel::Change& change);

  /// "vertices", "triangles" and "sections" of all chunks, "area" in voxels, "mesh_bytes".
  std::vector<std::pair<std::string, double>> figures() const;

 private:
  void mesh_chunk(const voxel::Map& map, mesh::Mesher& mesher, std::size_t index);

  MapSize size_;
  std::vector<mesh::ChunkMesh> meshes_;  // row by row
  std::vector<mesh::Mesher> meshers_;    // one a thread
};

}  // namespace earthwork::bench
