/// Which chunks an edit may look at: what tells that two edits have nothing to do with each other.
#pragma once

#include <span>
#include <vector>

#include "server/voxel/grid.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::voxel {

/// The chunks inside the bounds that the stencil may change, or a few more; empty when it lies
/// beyond them.
[[nodiscard]] ChunkRect chunks_under(const Grid& grid, const Stencil& stencil);

/// Of the stencils of one edit. A value; needs neither map nor stencils any more.
class Reach {
 public:
  /// Takes a moment a stencil, whatever its size.
  Reach(const Grid& grid, int layer, std::span<const Stencil> stencils);

  /// Whether one edit may change a chunk that the other one changes or reads. If not, both give the
  /// same chunks and the same Change in either order, or one in the midst of the other. Symmetric;
  /// may be true for edits that are near each other and do not meet.
  [[nodiscard]] bool meets(const Reach& other) const;

 private:
  int layer_;
  std::vector<ChunkRect> rects_;  // around some stencils each, in order
};

}  // namespace earthwork::voxel
