/// A large edit that is worked out beside the map, some stamps at a time, and put into it at once:
/// so that the map can take other edits in between, and nobody sees half of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"
#include "server/voxel/reach.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::voxel {

/// From its construction until `commit` the map may change wherever `reach` does not meet the
/// reach of what changes it. Map and result are then as if all stamps had been applied at the
/// moment of `commit`. On the map's thread.
class SlicedEdit {
 public:
  /// Does no work yet. `layer` and `stencils` are what Map::apply takes; the map outlives the edit.
  SlicedEdit(const Map& map, int layer, std::vector<Stencil> stencils);

  [[nodiscard]] const Reach& reach() const { return reach_; }

  /// Works out stamps until about `chunk_visits` chunks were looked at, a chunk once a stamp; one
  /// stamp at least. True when all are through.
  [[nodiscard]] bool advance(std::uint64_t chunk_visits);

  /// The chunks that `commit` replaces, after `advance` gave true. Valid as long as this is.
  [[nodiscard]] std::span<const ChunkKey> changed() const { return change_.changed; }

  /// Puts all of it into the map that it was made for, once, after `advance` gave true. What it
  /// gives is what Map::apply would have given, and is valid as long as this is.
  const Change& commit(Map& map);

 private:
  void seed(const ChunkRect& rect);

  const Map& map_;
  const int layer_;
  const std::vector<Stencil> stencils_;
  const Reach reach_;
  std::size_t next_ = 0;  // of stencils_
  Map shadow_;            // of the chunks that the stamps so far looked at
  std::unordered_set<ChunkKey, ChunkKeyHash> seeded_;
  ChunkRect last_seeded_;
  Change change_;
};

}  // namespace earthwork::voxel
