#include "server/room/mesh_cache.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::room {
namespace {

RecordBytes encoded(const protocol::ChunkRecord& record) {
  auto bytes = std::make_shared<std::string>();
  protocol::encode_record(record, *bytes);
  bytes->shrink_to_fit();
  return bytes;
}

}  // namespace

void MeshCache::mark_stale(const voxel::Change& change) {
  for (const voxel::DirtyChunk& dirty : change.dirty) stale_.insert(dirty.key);
}

const CachedMesh* MeshCache::current(const voxel::Map& map, const voxel::ChunkKey& key,
                                     std::uint64_t seq) {
  if (stale_.erase(key) != 0) {
    mesher_.mesh(map.neighbourhood(key), map.grid().resolution, scratch_);
    store(key, seq);
  }
  const auto found = meshes_.find(key);
  return found == meshes_.end() ? nullptr : &found->second;
}

bool MeshCache::refresh(const voxel::Map& map, std::uint64_t seq, std::size_t budget) {
  for (; budget > 0 && !stale_.empty(); --budget) {
    const voxel::ChunkKey key = *stale_.begin();
    current(map, key, seq);
  }
  return stale_.empty();
}

void MeshCache::store(const voxel::ChunkKey& key, std::uint64_t seq) {
  const auto found = meshes_.find(key);
  if (scratch_.empty()) {
    if (found != meshes_.end() && !found->second.removed) remove(found->second, key, seq);
    return;
  }

  protocol::ChunkRecord record{.key = to_protocol(key), .mesh = to_protocol(scratch_)};
  if (found != meshes_.end() && !found->second.removed) {
    // Encoded under the old revision, an unchanged mesh gives the old bytes.
    record.revision = found->second.revision;
    std::string again;
    protocol::encode_record(record, again);
    if (again == *found->second.bytes) return;
    count_out(found->second);
  }

  record.revision = seq;
  CachedMesh& cached = meshes_[key];
  cached = {.bytes = encoded(record),
            .revision = seq,
            .removed = false,
            .hash_term = protocol::mesh_hash_term(record.key, protocol::mesh_hash(record.mesh)),
            .triangles = record.mesh.triangles.size() / 3,
            .vertices = record.mesh.vertices.size()};
  totals_.hash += cached.hash_term;
  totals_.chunks += 1;
  totals_.triangles += cached.triangles;
  totals_.vertices += cached.vertices;
  totals_.bytes += cached.bytes->size();
}

void MeshCache::remove(CachedMesh& cached, const voxel::ChunkKey& key, std::uint64_t seq) {
  count_out(cached);
  cached = {
      .bytes = encoded({.key = to_protocol(key), .revision = seq, .removed = true, .mesh = {}}),
      .revision = seq,
      .removed = true};
}

void MeshCache::count_out(const CachedMesh& cached) {
  totals_.hash -= cached.hash_term;
  totals_.chunks -= 1;
  totals_.triangles -= cached.triangles;
  totals_.vertices -= cached.vertices;
  totals_.bytes -= cached.bytes->size();
}

bool MeshCache::may_have_mesh(const voxel::ChunkKey& key) const {
  if (stale_.contains(key)) return true;
  const auto found = meshes_.find(key);
  return found != meshes_.end() && !found->second.removed;
}

std::size_t MeshCache::count() const {
  const auto meshed = [&](const voxel::ChunkKey& key) {
    const auto found = meshes_.find(key);
    return found != meshes_.end() && !found->second.removed;
  };
  const auto both = std::count_if(stale_.begin(), stale_.end(), meshed);
  return totals_.chunks + stale_.size() - static_cast<std::size_t>(both);
}

std::vector<voxel::ChunkKey> MeshCache::keys() const {
  std::vector<voxel::ChunkKey> keys(stale_.begin(), stale_.end());
  for (const auto& [key, cached] : meshes_)
    if (!stale_.contains(key)) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<RecordBytes> MeshCache::records() const {
  std::vector<RecordBytes> records;
  records.reserve(totals_.chunks);
  for (const auto& [key, cached] : meshes_)
    if (!cached.removed) records.push_back(cached.bytes);
  return records;
}

}  // namespace earthwork::room
