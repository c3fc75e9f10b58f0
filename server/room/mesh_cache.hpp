/// The meshes of one map, encoded: made when somebody first needs them, and again when an edit
/// has touched their cells. Everything here can be made anew from the voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_set>
#include <vector>

#include "server/mesh/mesher.hpp"
#include "server/room/mesh_record.hpp"
#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// A chunk that has a mesh, or had one: then `bytes` says that it was removed.
struct CachedMesh {
  RecordBytes bytes;
  std::uint64_t revision = 0;  ///< The seq as of which a mesh other than the one before was seen.
  bool removed = false;
  std::uint64_t hash_term = 0;  ///< What it adds to the map's mesh hash; 0 when removed.
  std::size_t triangles = 0, vertices = 0;
};

/// Over all chunks that have a mesh.
struct MeshTotals {
  std::uint64_t hash = 0;
  std::size_t chunks = 0, triangles = 0, vertices = 0, bytes = 0;
  friend bool operator==(const MeshTotals&, const MeshTotals&) = default;
};

/// Holds at most one encoded record for each chunk of the map that has or had a mesh. One thread
/// at a time.
class MeshCache {
 public:
  /// Of an empty map.
  explicit MeshCache(double max_feature_angle) : mesher_(max_feature_angle) {}

  /// The cells of these chunks are different now.
  void mark_stale(const voxel::Change& change);

  /// The chunk's mesh as of `seq`, the number of the map's latest edit; null when it never had
  /// one. A mesh that came out as it was keeps its record and revision. Valid until the next call.
  const CachedMesh* current(const voxel::Map& map, const voxel::ChunkKey& key, std::uint64_t seq);

  /// Brings up to `budget` stale chunks up to date; true when none is left.
  bool refresh(const voxel::Map& map, std::uint64_t seq, std::size_t budget);

  /// It has a mesh, or may have one.
  [[nodiscard]] bool may_have_mesh(const voxel::ChunkKey& key) const;
  /// Every chunk that `may_have_mesh`, and those whose mesh was removed, in order.
  [[nodiscard]] std::vector<voxel::ChunkKey> keys() const;
  /// How many chunks `may_have_mesh`; takes time with the stale ones.
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::size_t stale_count() const { return stale_.size(); }

  /// True figures only when nothing is stale.
  [[nodiscard]] const MeshTotals& totals() const { return totals_; }
  /// The records of all chunks that have a mesh, in order of their keys. As of one seq only when
  /// nothing is stale.
  [[nodiscard]] std::vector<RecordBytes> records() const;

 private:
  void store(const voxel::ChunkKey& key, std::uint64_t seq);
  void remove(CachedMesh& cached, const voxel::ChunkKey& key, std::uint64_t seq);
  void count_out(const CachedMesh& cached);

  mesh::Mesher mesher_;
  mesh::ChunkMesh scratch_;
  std::map<voxel::ChunkKey, CachedMesh> meshes_;
  std::unordered_set<voxel::ChunkKey, voxel::ChunkKeyHash> stale_;
  MeshTotals totals_;
};

}  // namespace earthwork::room
