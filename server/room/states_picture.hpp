/// The voxel states of one layer as rows of pixels: what a states.png shows.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/result.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

inline constexpr std::uint64_t kMaxPicturePixels = std::uint64_t{1} << 28;

/// One bit a voxel, 1 empty and 0 filled: black on white. Rows from the top (highest y) down,
/// `row_bytes` each, the leftmost voxel in the highest bit. The width is a multiple of 8.
struct StatesPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> bits;
  [[nodiscard]] std::size_t row_bytes() const { return width / 8; }
};

/// The map's bounds, or the smallest rectangle of chunks that holds all that the layer holds.
/// Fails with out_of_range for a layer that the map does not have, with too_large beyond
/// kMaxPicturePixels, and with bad_state when an empty layer has no bounds.
[[nodiscard]] protocol::Result<StatesPicture> draw_states(const voxel::Map& map,
                                                          std::uint64_t layer);

}  // namespace earthwork::room
