#include "server/room/mesh_maker.hpp"

#include <string_view>
#include <utility>

#include "protocol/record_delta.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::room {
namespace {

/// What of a full record does not depend on its revision. The chunk's key is left out too.
std::string_view mesh_part(std::string_view record) {
  return record.substr(protocol::kRecordLengthBytes + protocol::kRecordHeadBytes);
}

CachedMesh removal(const voxel::ChunkKey& key, std::uint64_t seq) {
  std::string bytes;
  protocol::encode_record({.key = to_protocol(key), .revision = seq, .removed = true, .mesh = {}},
                          bytes);
  bytes.shrink_to_fit();
  return {.bytes = std::make_shared<const std::string>(std::move(bytes)),
          .revision = seq,
          .removed = true};
}

}  // namespace

std::optional<CachedMesh> MeshMaker::make(const voxel::ChunkKey& key,
                                          const voxel::Neighbourhood& chunks, int resolution,
                                          const Forerunner& before) {
  const bool had_mesh = before.mesh && !before.mesh->removed;
  mesher_.mesh(chunks, resolution, mesh_);
  if (mesh_.empty()) {
    if (!had_mesh && !before.seen_unknown) return std::nullopt;
    return removal(key, before.revision);
  }
  const protocol::ChunkRecord record{
      .key = to_protocol(key), .revision = before.revision, .mesh = to_protocol(mesh_)};
  bytes_.clear();
  protocol::encode_record(record, bytes_);
  if (had_mesh && mesh_part(bytes_) == mesh_part(*before.mesh->bytes)) return std::nullopt;
  CachedMesh made{
      .bytes = std::make_shared<const std::string>(bytes_.begin(), bytes_.end()),
      .revision = before.revision,
      .removed = false,
      .hash_term = protocol::mesh_hash_term(record.key, protocol::mesh_hash(record.mesh)),
      .triangles = record.mesh.triangles.size() / 3,
      .vertices = record.mesh.vertices.size()};
  delta_.clear();
  if (had_mesh && protocol::encode_delta(*before.mesh->bytes, bytes_, delta_)) {
    made.delta = std::make_shared<const std::string>(delta_.begin(), delta_.end());
    made.base_revision = before.mesh->revision;
  }
  return made;
}

}  // namespace earthwork::room
