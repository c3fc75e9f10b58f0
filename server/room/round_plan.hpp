/// What the next round of meshing is to make, put together from what viewers wait for.
#pragma once

#include <cstddef>
#include <unordered_set>
#include <vector>

#include "server/room/mesh_cache.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::room {

/// First-seen chunks of a round, of all viewers together: so that loads do not keep the groups of
/// others waiting for long.
inline constexpr std::size_t kRoundFirstSeen = 128;

/// Stale chunks only, each once. Outlived by the cache, which does not change meanwhile.
class RoundPlan {
 public:
  explicit RoundPlan(const MeshCache& meshes) : meshes_(meshes) {}

  void add_owed(const voxel::ChunkKey& key) { add(key); }
  /// Not for more than kRoundFirstSeen. Gives back whether the plan grew.
  bool add_first_seen(const voxel::ChunkKey& key) {
    if (!takes_first_seen() || !add(key)) return false;
    ++first_seen_;
    return true;
  }
  [[nodiscard]] bool takes_first_seen() const { return first_seen_ < kRoundFirstSeen; }

  [[nodiscard]] const std::vector<voxel::ChunkKey>& keys() const { return keys_; }

 private:
  bool add(const voxel::ChunkKey& key) {
    if (!meshes_.stale(key) || !known_.insert(key).second) return false;
    keys_.push_back(key);
    return true;
  }

  const MeshCache& meshes_;
  std::vector<voxel::ChunkKey> keys_;
  std::unordered_set<voxel::ChunkKey, voxel::ChunkKeyHash> known_;
  std::size_t first_seen_ = 0;
};

}  // namespace earthwork::room
