#include "server/room/states_picture.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace earthwork::room {
namespace {

using protocol::Code;

/// The smallest rectangle around `keys` of this layer.
std::optional<voxel::ChunkRect> around(const std::vector<voxel::ChunkKey>& keys,
                                       std::int32_t layer) {
  std::optional<voxel::ChunkRect> rect;
  for (const voxel::ChunkKey& key : keys) {
    if (key.layer != layer) continue;
    if (!rect) rect = voxel::ChunkRect{key.x, key.y, key.x + 1, key.y + 1};
    rect->x0 = std::min(rect->x0, key.x), rect->x1 = std::max(rect->x1, key.x + 1);
    rect->y0 = std::min(rect->y0, key.y), rect->y1 = std::max(rect->y1, key.y + 1);
  }
  return rect;
}

/// Eight voxels, the lowest bit leftmost, as PNG wants them: the highest bit leftmost.
std::uint8_t mirrored(std::uint64_t eight) {
  // Each step swaps neighbouring groups of 4, 2 and 1 bits.
  std::uint64_t v = eight & 0xFF;
  v = (v & 0xF0) >> 4 | (v & 0x0F) << 4;
  v = (v & 0xCC) >> 2 | (v & 0x33) << 2;
  v = (v & 0xAA) >> 1 | (v & 0x55) << 1;
  return static_cast<std::uint8_t>(v);
}

void draw(const voxel::Chunk& chunk, std::size_t column_byte, std::size_t bottom_row,
          StatesPicture& picture) {
  for (int y = 0; y < chunk.resolution(); ++y) {
    const std::uint64_t row = chunk.row(y);
    const std::size_t picture_row = bottom_row - static_cast<std::size_t>(y);
    std::uint8_t* out = picture.bits.data() + picture_row * picture.row_bytes() + column_byte;
    for (int x = 0; x < chunk.resolution(); x += 8)
      *out++ = static_cast<std::uint8_t>(~mirrored(row >> x));
  }
}

}  // namespace

protocol::Result<StatesPicture> draw_states(const voxel::Map& map, std::uint64_t layer) {
  const auto layers = static_cast<std::uint64_t>(map.grid().layers);
  if (layer >= layers)
    return protocol::fail(Code::out_of_range,
                          "layer: 0 .. " + std::to_string(layers - 1) + " in this map", "layer");

  const auto keys = map.keys();
  const auto index = static_cast<std::int32_t>(layer);
  const auto rect = map.grid().bounds ? map.grid().bounds : around(keys, index);
  if (!rect)
    return protocol::fail(Code::bad_state, "layer: it is empty and has no bounds", "layer");

  const auto side = static_cast<std::uint64_t>(map.grid().resolution);
  const std::uint64_t width = side * static_cast<std::uint64_t>(rect->x1 - rect->x0);
  const std::uint64_t height = side * static_cast<std::uint64_t>(rect->y1 - rect->y0);
  if (width > kMaxPicturePixels / height)
    return protocol::fail(Code::too_large, "a picture of " + std::to_string(width) + " x " +
                                               std::to_string(height) + " voxels; at most " +
                                               std::to_string(kMaxPicturePixels));

  StatesPicture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  picture.bits.assign(width / 8 * height, 0xFF);
  for (const voxel::ChunkKey& key : keys) {
    if (key.layer != index) continue;
    const auto column = static_cast<std::size_t>(key.x - rect->x0) * side;
    const auto row = static_cast<std::size_t>(rect->y1 - key.y) * side - 1;
    draw(*map.find(key), column / 8, row, picture);
  }
  return picture;
}

}  // namespace earthwork::room
