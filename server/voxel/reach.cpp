#include "server/voxel/reach.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace earthwork::voxel {
namespace {

// A path is covered by a rectangle around so many stamps of it after each other: a long one that
// runs across the map then does not reach everything beside it.
constexpr std::size_t kStampsARect = 64;

ChunkRect united(const ChunkRect& a, const ChunkRect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// An edge's crossing is read and written with the chunk of its lower end, so the neighbours to the
// right and above are read too; a whole ring is a little more than that.
ChunkRect with_ring(const ChunkRect& r) { return {r.x0 - 1, r.y0 - 1, r.x1 + 1, r.y1 + 1}; }

bool overlap(const ChunkRect& a, const ChunkRect& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

// Voxels are looked for one further than the outline, and the one before the first that is covered
// owns the edge to it.
ChunkRect chunks_under(const Grid& grid, const Stencil& stencil) {
  const auto first = [&](double centre) {
    const double at = std::floor((centre - stencil.radius) / grid.voxel_size - 0.5);
    return grid.chunk_of(static_cast<std::int32_t>(at) - 2);
  };
  const auto end = [&](double centre) {
    const double at = std::ceil((centre + stencil.radius) / grid.voxel_size - 0.5);
    return grid.chunk_of(static_cast<std::int32_t>(at) + 1) + 1;
  };
  const ChunkRect extent = grid.extent();
  const ChunkRect rect{std::max(first(stencil.x), extent.x0), std::max(first(stencil.y), extent.y0),
                       std::min(end(stencil.x), extent.x1), std::min(end(stencil.y), extent.y1)};
  return rect.empty() ? ChunkRect{} : rect;
}

Reach::Reach(const Grid& grid, int layer, std::span<const Stencil> stencils) : layer_(layer) {
  for (std::size_t from = 0; from < stencils.size(); from += kStampsARect) {
    ChunkRect rect;
    for (const Stencil& s : stencils.subspan(from, std::min(kStampsARect, stencils.size() - from)))
      rect = united(rect, chunks_under(grid, s));
    if (!rect.empty()) rects_.push_back(rect);
  }
}

bool Reach::meets(const Reach& other) const {
  if (layer_ != other.layer_) return false;
  return std::any_of(rects_.begin(), rects_.end(), [&](const ChunkRect& mine) {
    return std::any_of(other.rects_.begin(), other.rects_.end(),
                       [&](const ChunkRect& theirs) { return overlap(with_ring(mine), theirs); });
  });
}

}  // namespace earthwork::voxel
