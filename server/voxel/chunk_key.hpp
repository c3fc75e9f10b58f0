/// The name of a chunk: its layer, and its place in the grid of chunks.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace earthwork::voxel {

/// Chunk (x, y, z) of a layer, counted in chunks from the map's origin; z is 0 in a 2D map.
/// Ordered by layer, then x, y, z.
struct ChunkKey {
  std::int32_t layer = 0, x = 0, y = 0, z = 0;
  friend auto operator<=>(const ChunkKey&, const ChunkKey&) = default;
};

/// Hash for look-ups; nothing stored or sent depends on it.
struct ChunkKeyHash {
  std::size_t operator()(const ChunkKey& k) const {
    const auto low =
        static_cast<std::uint32_t>(k.x) | std::uint64_t{static_cast<std::uint32_t>(k.y)} << 32;
    const auto high =
        static_cast<std::uint32_t>(k.layer) | std::uint64_t{static_cast<std::uint32_t>(k.z)} << 32;
    std::uint64_t h = low * 0x9E3779B97F4A7C15u ^ high * 0xC2B2AE3D27D4EB4Fu;
    h ^= h >> 32;
    return static_cast<std::size_t>(h * 0x9E3779B97F4A7C15u);
  }
};

}  // namespace earthwork::voxel
