#include "server/voxel/sliced_edit.hpp"

#include <cassert>
#include <utility>

namespace earthwork::voxel {
namespace {

bool inside(const ChunkRect& inner, const ChunkRect& outer) {
  return outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && inner.x1 <= outer.x1 &&
         inner.y1 <= outer.y1;
}

std::uint64_t area(const ChunkRect& rect) {
  return static_cast<std::uint64_t>(rect.x1 - rect.x0) *
         static_cast<std::uint64_t>(rect.y1 - rect.y0);
}

}  // namespace

SlicedEdit::SlicedEdit(const Map& map, int layer, std::vector<Stencil> stencils)
    : map_(map),
      layer_(layer),
      stencils_(std::move(stencils)),
      reach_(map.grid(), layer, stencils_),
      shadow_(map.grid()) {}

bool SlicedEdit::advance(std::uint64_t chunk_visits) {
  const std::size_t first = next_;
  std::uint64_t visits = 0;
  while (next_ < stencils_.size() && (next_ == first || visits < chunk_visits)) {
    const ChunkRect rect = chunks_under(map_.grid(), stencils_[next_++]);
    visits += area(rect);
    seed(rect);
  }
  const std::span<const Stencil> all = stencils_;
  add(change_, shadow_.apply(layer_, all.subspan(first, next_ - first)));
  return next_ == stencils_.size();
}

// A copy shares its voxels with the map's chunk until a stamp changes it. One that the stamps have
// emptied is gone from the shadow and must not come back, hence the list of those that were taken.
void SlicedEdit::seed(const ChunkRect& rect) {
  if (rect.empty() || inside(rect, last_seeded_)) return;
  last_seeded_ = rect;
  const ChunkRect extent = map_.grid().extent();
  for (std::int32_t y = rect.y0; y <= rect.y1 && y < extent.y1; ++y) {
    for (std::int32_t x = rect.x0; x <= rect.x1 && x < extent.x1; ++x) {
      const ChunkKey key{layer_, x, y, 0};
      if (!seeded_.insert(key).second) continue;
      if (const Chunk* chunk = map_.find(key)) shadow_.put(key, *chunk);
    }
  }
}

const Change& SlicedEdit::commit(Map& map) {
  assert(&map == &map_ && next_ == stencils_.size());
  for (const ChunkKey& key : change_.changed) {
    const Chunk* chunk = shadow_.find(key);
    map.put(key, chunk ? *chunk : Chunk(map.grid().resolution));
  }
  return change_;
}

}  // namespace earthwork::voxel
