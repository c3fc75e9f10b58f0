/// What an edit changed: the chunks whose voxels or crossings are different now, and the cells
/// that must be meshed again.
#pragma once

#include <cstdint>
#include <vector>

#include "server/voxel/chunk_key.hpp"

namespace earthwork::voxel {

/// Cells x0 <= x < x1, y0 <= y < y1 of a chunk, in voxels from its lower left.
struct CellRect {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  friend bool operator==(const CellRect&, const CellRect&) = default;
};

struct DirtyChunk {
  ChunkKey key;
  CellRect cells;  ///< Never empty; a cell outside it has the mesh it had.
  friend bool operator==(const DirtyChunk&, const DirtyChunk&) = default;
};

/// Both lists run from the top row of chunks to the bottom one, right to left within a row, and
/// name a chunk once. A chunk is in `dirty` for its own cells: also when only its right, upper or
/// upper-right neighbour changed, and even if it holds nothing itself.
struct Change {
  std::vector<ChunkKey> changed;
  std::vector<DirtyChunk> dirty;
  void clear() { changed.clear(), dirty.clear(); }
  friend bool operator==(const Change&, const Change&) = default;
};

/// Makes a Change of what was noted in any order, a chunk any number of times.
void put_in_order(Change& change);
/// Adds to `all` what came after it: one change of both. Takes time with the chunks of both.
void add(Change& all, const Change& more);

}  // namespace earthwork::voxel
