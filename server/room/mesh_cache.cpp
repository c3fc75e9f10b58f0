#include "server/room/mesh_cache.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace earthwork::room {
namespace {

MeshTotals contribution(const CachedMesh& cached) {
  if (cached.removed) return {};
  return {cached.hash_term, 1, cached.triangles, cached.vertices, cached.bytes->size()};
}

}  // namespace

const CachedMesh* MeshCache::find(const voxel::ChunkKey& key) const {
  const auto found = meshes_.find(key);
  return found == meshes_.end() ? nullptr : &found->second;
}

void MeshCache::put(const voxel::ChunkKey& key, std::optional<CachedMesh> made) {
  if (made) {
    const auto [place, first] = meshes_.try_emplace(key);
    const MeshTotals before = first ? MeshTotals{} : contribution(place->second);
    const MeshTotals now = contribution(*made);
    totals_.hash += now.hash - before.hash;
    totals_.chunks += now.chunks - before.chunks;
    totals_.triangles += now.triangles - before.triangles;
    totals_.vertices += now.vertices - before.vertices;
    totals_.bytes += now.bytes - before.bytes;
    place->second = std::move(*made);
  }
  stale_.erase(key);
}

std::vector<voxel::ChunkKey> MeshCache::some_stale(std::size_t most) const {
  const auto count = static_cast<std::ptrdiff_t>(std::min(most, stale_.size()));
  return {stale_.begin(), std::next(stale_.begin(), count)};
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
