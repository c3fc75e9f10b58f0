/// Applies one stencil to one chunk: its voxels, then the crossings of the edges that leave them.
#pragma once

#include <cstdint>
#include <vector>

#include "server/voxel/change.hpp"
#include "server/voxel/chunk.hpp"
#include "server/voxel/coverage.hpp"

namespace earthwork::voxel {

/// Where a chunk lies, and what its last edges lead to.
struct ChunkPlace {
  std::int32_t x = 0, y = 0;     ///< The chunk's first voxel, in voxels of the map.
  bool has_right = true;         ///< There is ground beyond the last column,
  bool has_upper = true;         ///< and beyond the last row.
  const Chunk* right = nullptr;  ///< The stencil is applied there already; null is empty ground.
  const Chunk* upper = nullptr;
};

/// Cells to mesh again, in the chunk and in the neighbours whose last column or row reaches into
/// it. Rectangles are in voxels of the chunk they are in; an empty one asks for nothing.
struct Touched {
  bool chunk = false;  ///< A voxel or crossing is different.
  CellRect own, left, lower, lower_left;
};

/// Keeps scratch memory between calls; nothing else.
class ChunkEdit {
 public:
  Touched apply(const Coverage& coverage, const ChunkPlace& place, Chunk& chunk);

 private:
  struct RowChange;
  class Tally;
  struct NewRow {
    std::uint64_t mask, lower, upper;  // all new crossings; those cut from a covered end
  };

  void set_states(const Coverage& coverage, const ChunkPlace& place, Chunk& chunk);
  void set_crossings(Axis axis, const Coverage& coverage, const ChunkPlace& place, Chunk& chunk);
  NewRow new_row(Axis axis, int y, const Coverage& coverage, const ChunkPlace& place,
                 const Chunk& chunk) const;
  std::uint64_t rebuild_row(Axis axis, int y, const NewRow& row, const Coverage& coverage,
                            const ChunkPlace& place, const Chunk& chunk);
  void store_rows(Axis axis, Chunk& chunk);
  static void materialise(Chunk& chunk);
  static void simplify(Chunk& chunk);

  int first_row_ = 0, last_row_ = -1;      // the rows that the stencil can change
  std::vector<std::uint64_t> states_;      // which voxels changed, a word for each of them
  std::vector<std::uint64_t> changes_[2];  // which x and y crossings did
  std::vector<std::uint64_t> masks_;       // of the rows being rebuilt
  std::vector<std::uint16_t> counts_;
  std::vector<Crossing> packed_;
};

}  // namespace earthwork::voxel
