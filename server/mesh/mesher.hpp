/// Makes the mesh of a chunk from its voxels and those of its three upper neighbours.
#pragma once

#include <memory>

#include "server/mesh/chunk_mesh.hpp"
#include "server/mesh/feature.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::mesh {

/// Holds scratch memory only: the result depends on the arguments alone. One thread at a time.
class Mesher {
 public:
  /// `max_feature_angle` in degrees, > 0 and <= 175.
  explicit Mesher(double max_feature_angle);
  Mesher(Mesher&&) noexcept;
  Mesher& operator=(Mesher&&) noexcept;
  ~Mesher();

  /// Replaces `out`, reusing its memory. `resolution` is the map's.
  void mesh(const voxel::Neighbourhood& chunks, int resolution, ChunkMesh& out);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace earthwork::mesh
