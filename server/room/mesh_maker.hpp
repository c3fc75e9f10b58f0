/// Makes a chunk's mesh from its voxels and encodes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "server/mesh/mesher.hpp"
#include "server/room/mesh_cache.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// Holds scratch memory only: the result depends on the arguments alone. One thread at a time.
class MeshMaker {
 public:
  /// `max_feature_angle` in degrees, > 0 and <= 175.
  explicit MeshMaker(double max_feature_angle) : mesher_(max_feature_angle) {}

  /// The mesh of chunk `key`, after `before`. Nothing when it is no other one: then what was before
  /// goes on, with its revision.
  [[nodiscard]] std::optional<CachedMesh> make(const voxel::ChunkKey& key,
                                               const voxel::Neighbourhood& chunks, int resolution,
                                               const Forerunner& before);

 private:
  mesh::Mesher mesher_;
  mesh::ChunkMesh mesh_;
  std::string bytes_, delta_;
};

}  // namespace earthwork::room
