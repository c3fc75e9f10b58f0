/// The voxels that a chunk's mesh depends on, kept as they are now.
#pragma once

#include "server/voxel/map.hpp"

namespace earthwork::voxel {

/// Copies of a chunk and its upper neighbours, which share their voxels with the map until it
/// changes them. Needs no map any more; any thread may use it and let it go.
class KeptNeighbourhood {
 public:
  /// On the map's thread.
  KeptNeighbourhood(const Map& map, const ChunkKey& key)
      : KeptNeighbourhood(map.neighbourhood(key), map.grid().resolution) {}

  int resolution() const { return own_.resolution(); }
  /// Valid as long as this is.
  Neighbourhood view() const {
    return {&own_, &right_, &upper_, &upper_right_, has_right_, has_upper_};
  }

 private:
  KeptNeighbourhood(const Neighbourhood& chunks, int resolution)
      : own_(kept(chunks.own, resolution)),
        right_(kept(chunks.right, resolution)),
        upper_(kept(chunks.upper, resolution)),
        upper_right_(kept(chunks.upper_right, resolution)),
        has_right_(chunks.has_right),
        has_upper_(chunks.has_upper) {}
  static Chunk kept(const Chunk* chunk, int resolution) {
    return chunk ? *chunk : Chunk(resolution);  // no chunk is empty ground
  }

  Chunk own_, right_, upper_, upper_right_;
  bool has_right_, has_upper_;
};

}  // namespace earthwork::voxel
