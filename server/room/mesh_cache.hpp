/// The meshes of one map, encoded, as of one seq: made when somebody first needs them, and again
/// when an edit has touched their cells. Everything here can be made anew from the voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "server/room/mesh_record.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::room {

/// Over all chunks that have a mesh.
struct MeshTotals {
  std::uint64_t hash = 0;
  std::size_t chunks = 0, triangles = 0, vertices = 0, bytes = 0;
  friend bool operator==(const MeshTotals&, const MeshTotals&) = default;
};

/// Holds at most one encoded record for each chunk of the map that has or had a mesh. Starts as
/// that of an empty map. One thread at a time.
class MeshCache {
 public:
  /// The cells of these chunks are different now.
  void mark_stale(std::span<const voxel::ChunkKey> keys) {
    stale_.insert(keys.begin(), keys.end());
  }
  /// What `find` gives is not the chunk's mesh.
  [[nodiscard]] bool stale(const voxel::ChunkKey& key) const { return stale_.contains(key); }
  /// The mesh that the chunk had last; null when it never had one. Valid until it is put.
  [[nodiscard]] const CachedMesh* find(const voxel::ChunkKey& key) const;
  /// The chunk's mesh is `made` now, or what it was when that is nothing.
  void put(const voxel::ChunkKey& key, std::optional<CachedMesh> made);

  [[nodiscard]] std::size_t stale_count() const { return stale_.size(); }
  /// Up to `most` stale chunks, any.
  [[nodiscard]] std::vector<voxel::ChunkKey> some_stale(std::size_t most) const;

  /// It has a mesh, or may have one.
  [[nodiscard]] bool may_have_mesh(const voxel::ChunkKey& key) const;
  /// Every chunk that `may_have_mesh`, and those whose mesh was removed, in order.
  [[nodiscard]] std::vector<voxel::ChunkKey> keys() const;
  /// How many chunks `may_have_mesh`; takes time with the stale ones.
  [[nodiscard]] std::size_t count() const;

  /// True figures only when nothing is stale.
  [[nodiscard]] const MeshTotals& totals() const { return totals_; }
  /// The records of all chunks that have a mesh, in order of their keys. As of one seq only when
  /// nothing is stale.
  [[nodiscard]] std::vector<RecordBytes> records() const;

 private:
  std::map<voxel::ChunkKey, CachedMesh> meshes_;
  std::unordered_set<voxel::ChunkKey, voxel::ChunkKeyHash> stale_;
  MeshTotals totals_;
};

}  // namespace earthwork::room
