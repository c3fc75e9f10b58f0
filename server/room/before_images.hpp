/// A map's chunks as they were before edits that may have to be taken back.
#pragma once

#include <optional>
#include <span>
#include <unordered_map>

#include "server/voxel/chunk.hpp"
#include "server/voxel/chunk_key.hpp"
#include "server/voxel/map.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::room {

/// Copies share their voxels with the map until it changes them. Kept in two parts, like what
/// changed them: what is on its way into the journal, and what has gathered since. One thread at a
/// time.
class BeforeImages {
 public:
  /// These chunks are about to change. What was kept of a chunk since the last `hand_over` stays.
  void keep(const voxel::Map& map, std::span<const voxel::ChunkKey> keys);
  /// So are those that the stencils may change.
  void keep(const voxel::Map& map, int layer, std::span<const voxel::Stencil> stencils);

  /// What has gathered is on its way. Nothing else is.
  void hand_over();
  /// What was on its way is through.
  void forget_handed_over() { handed_over_.clear(); }
  /// Makes the map what it was before all of it. Nothing is kept afterwards.
  void take_back(voxel::Map& map);

 private:
  using Images = std::unordered_map<voxel::ChunkKey, std::optional<voxel::Chunk>,
                                    voxel::ChunkKeyHash>;  // nothing: there was no chunk

  void keep(const voxel::Map& map, const voxel::ChunkKey& key);
  static void put_back(Images& images, voxel::Map& map);

  Images gathered_, handed_over_;
};

}  // namespace earthwork::room
