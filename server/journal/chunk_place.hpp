/// A chunk's place as one number, so that what is near in the map is near in the file.
#pragma once

#include <cstdint>
#include <optional>

#include "server/voxel/chunk_key.hpp"

namespace earthwork::journal {

/// x, y and z, each plus 2^20 and of 21 bits, their bits in turns: bit 3k is bit k of x, 3k + 1 of
/// y, 3k + 2 of z (Morton order). Chunk (0, 0, 0) is 7 * 2^60, chunk (1, 0, 0) one more.
[[nodiscard]] std::int64_t place_of(const voxel::ChunkKey& key);

/// The key in this layer; nothing for a negative place.
[[nodiscard]] std::optional<voxel::ChunkKey> key_of(std::int32_t layer, std::int64_t place);

}  // namespace earthwork::journal
