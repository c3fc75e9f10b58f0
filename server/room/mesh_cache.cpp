#include "server/room/mesh_cache.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace earthwork::room {
namespace {

MeshTotals contribution(const CachedMesh& cached) {
  if (cached.removed || !cached.bytes) return {};
  return {cached.hash_term, 1, cached.triangles, cached.vertices, cached.bytes->size()};
}

}  // namespace

const CachedMesh* MeshCache::find(const voxel::ChunkKey& key) const {
  const auto found = meshes_.find(key);
  return found == meshes_.end() ? nullptr : &found->second;
}

// The cells of a chunk reach into the chunks to its right, above and above right. So its mesh was
// last another one by an event that is not after the age of the youngest of the four. It has a mesh
// only when the map keeps the chunk itself, whose edges lead to what is filled to its right or
// above; or when the one voxel is filled above right that no edge of it leads to.
void MeshCache::restore(const voxel::Map& map, std::span<const journal::ChunkAge> ages) {
  assert(stale_.empty() && meshes_.empty());
  const voxel::ChunkRect extent = map.grid().extent();
  stale_.reserve(2 * ages.size());
  for (const auto& [key, seq] : ages) {
    const voxel::Chunk* chunk = map.find(key);
    const bool corner = chunk && chunk->filled(0, 0);
    for (const auto& [dx, dy, shows] :
         {std::tuple{0, 0, chunk != nullptr}, {-1, 0, false}, {0, -1, false}, {-1, -1, corner}}) {
      const voxel::ChunkKey reaching{key.layer, key.x + dx, key.y + dy, key.z};
      if (!extent.contains(reaching.x, reaching.y)) continue;
      const auto [place, first] = stale_.try_emplace(reaching);
      Stale& stale = place->second;
      if (first) stale.seen_unknown = stale.bare = true;
      stale.revision = std::max(stale.revision, seq);
      if (shows) stale.bare = false;
    }
  }
  for (auto& [key, stale] : stale_) without_mesh_ += stale.without_mesh = !stale.bare;
}

void MeshCache::mark_stale(std::span<const voxel::ChunkKey> keys) {
  for (const voxel::ChunkKey& key : keys) touch(key);
}

void MeshCache::touch(const voxel::ChunkKey& key) {
  const auto [place, first] = stale_.try_emplace(key);
  Stale& stale = place->second;
  if (first || stale.revision != 0) ++dirty_;
  stale.revision = 0;
  if (!first && !stale.bare) return;
  stale.bare = false;
  const CachedMesh* mesh = find(key);
  stale.without_mesh = !mesh || mesh->removed;
  if (stale.without_mesh) ++without_mesh_;
}

void MeshCache::forget_stale(StaleOnes::iterator place) {
  if (place == stale_.end()) return;
  if (place->second.without_mesh) --without_mesh_;
  if (place->second.revision == 0) --dirty_;
  stale_.erase(place);
}

Forerunner MeshCache::forerunner(const voxel::ChunkKey& key, std::uint64_t seq) const {
  Forerunner before{.mesh = {}, .seen_unknown = false, .revision = seq};
  if (const CachedMesh* mesh = find(key)) before.mesh = *mesh;
  if (const auto found = stale_.find(key); found != stale_.end()) {
    before.seen_unknown = found->second.seen_unknown;
    if (found->second.revision != 0) before.revision = found->second.revision;
  }
  return before;
}

void MeshCache::put(const voxel::ChunkKey& key, std::optional<CachedMesh> made) {
  if (made) replace(key, std::move(made));
  forget_stale(stale_.find(key));
}

// The revision of the next one is the seq as of which it is made: that is never too low.
void MeshCache::take_back(const voxel::ChunkKey& key, Forerunner before) {
  replace(key, std::move(before.mesh));
  forget_stale(stale_.find(key));
  touch(key);
  stale_[key].seen_unknown = before.seen_unknown;
}

void MeshCache::replace(const voxel::ChunkKey& key, std::optional<CachedMesh> mesh) {
  const auto place = meshes_.try_emplace(key).first;
  const MeshTotals before = contribution(place->second);
  const MeshTotals now = mesh ? contribution(*mesh) : MeshTotals{};
  totals_.hash += now.hash - before.hash;
  totals_.chunks += now.chunks - before.chunks;
  totals_.triangles += now.triangles - before.triangles;
  totals_.vertices += now.vertices - before.vertices;
  totals_.bytes += now.bytes - before.bytes;
  if (mesh)
    place->second = std::move(*mesh);
  else
    meshes_.erase(place);
}

std::vector<voxel::ChunkKey> MeshCache::some_stale(std::size_t most) const {
  std::vector<voxel::ChunkKey> keys;
  keys.reserve(std::min(most, stale_.size()));
  for (auto next = stale_.begin(); next != stale_.end() && keys.size() < most; ++next)
    keys.push_back(next->first);
  return keys;
}

bool MeshCache::may_have_mesh(const voxel::ChunkKey& key) const {
  if (const auto found = stale_.find(key); found != stale_.end()) return !found->second.bare;
  const auto found = meshes_.find(key);
  return found != meshes_.end() && !found->second.removed;
}

std::vector<voxel::ChunkKey> MeshCache::keys() const {
  std::vector<voxel::ChunkKey> keys;
  keys.reserve(stale_.size() + meshes_.size());
  for (const auto& [key, stale] : stale_) keys.push_back(key);
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
