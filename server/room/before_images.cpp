#include "server/room/before_images.hpp"

#include <cassert>
#include <utility>

#include "server/voxel/grid.hpp"
#include "server/voxel/reach.hpp"

namespace earthwork::room {

void BeforeImages::keep(const voxel::Map& map, const voxel::ChunkKey& key) {
  const auto [image, first] = gathered_.try_emplace(key);
  if (!first) return;
  if (const voxel::Chunk* chunk = map.find(key)) image->second = *chunk;
}

void BeforeImages::keep(const voxel::Map& map, std::span<const voxel::ChunkKey> keys) {
  for (const voxel::ChunkKey& key : keys) keep(map, key);
}

void BeforeImages::keep(const voxel::Map& map, int layer,
                        std::span<const voxel::Stencil> stencils) {
  voxel::ChunkRect last;  // a path's stamps are mostly over the same chunks
  for (const voxel::Stencil& stencil : stencils) {
    const voxel::ChunkRect rect = voxel::chunks_under(map.grid(), stencil);
    if (rect == last) continue;
    last = rect;
    for (std::int32_t y = rect.y0; y < rect.y1; ++y)
      for (std::int32_t x = rect.x0; x < rect.x1; ++x) keep(map, {layer, x, y, 0});
  }
}

void BeforeImages::hand_over() {
  assert(handed_over_.empty());
  handed_over_ = std::exchange(gathered_, {});
}

void BeforeImages::take_back(voxel::Map& map) {
  put_back(gathered_, map);
  put_back(handed_over_, map);  // the older ones last
}

void BeforeImages::put_back(Images& images, voxel::Map& map) {
  for (auto& [key, image] : images)
    map.put(key, image ? std::move(*image) : voxel::Chunk(map.grid().resolution));
  images.clear();
}

}  // namespace earthwork::room
