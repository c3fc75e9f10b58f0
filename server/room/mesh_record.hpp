/// From a chunk's mesh as the mesher makes it to the bytes that viewers are sent.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "protocol/chunk_record.hpp"
#include "server/mesh/chunk_mesh.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::room {

/// An encoded chunk record: made once, shared by the cache and all viewers that it is sent to.
using RecordBytes = std::shared_ptr<const std::string>;

[[nodiscard]] protocol::ChunkKey to_protocol(const voxel::ChunkKey& key);
[[nodiscard]] protocol::ChunkMesh to_protocol(const mesh::ChunkMesh& mesh);

}  // namespace earthwork::room
