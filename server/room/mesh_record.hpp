/// A chunk's mesh as viewers are sent it, and what is known of it beside its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "protocol/chunk_record.hpp"
#include "server/mesh/chunk_mesh.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::room {

/// An encoded chunk record: made once, shared by the cache and all viewers that it is sent to.
using RecordBytes = std::shared_ptr<const std::string>;

/// The mesh of a chunk that has one, or had one: then `bytes` says that it was removed. Cheap to
/// copy.
struct CachedMesh {
  RecordBytes bytes;
  std::uint64_t revision = 0;  ///< The seq as of which a mesh other than the one before was seen.
  bool removed = false;
  std::uint64_t hash_term = 0;  ///< What it adds to the map's mesh hash; 0 when removed.
  std::size_t triangles = 0, vertices = 0;
  RecordBytes delta{};              ///< From the mesh before it, where that takes fewer bytes;
  std::uint64_t base_revision = 0;  ///< then that mesh's revision.
};

[[nodiscard]] protocol::ChunkKey to_protocol(const voxel::ChunkKey& key);
[[nodiscard]] protocol::ChunkMesh to_protocol(const mesh::ChunkMesh& mesh);

}  // namespace earthwork::room
