/// The fixed frame of a map: how many voxels a chunk has, how large they are, where the map ends.
#pragma once

#include <cstdint>
#include <optional>

namespace earthwork::voxel {

inline constexpr int kMaxResolution = 64;  ///< Voxels along a chunk's side, at most.
/// Where a map without bounds ends, in voxels from 0: all that a stencil of 512 voxels centred
/// within 10^6 can reach, and a whole number of chunks of any size.
inline constexpr int kWorldVoxels = 1'000'576;
inline constexpr int kMaxLayers = 16;

/// Chunks x0 <= x < x1, y0 <= y < y1.
struct ChunkRect {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool contains(std::int32_t x, std::int32_t y) const {
    return x0 <= x && x < x1 && y0 <= y && y < y1;
  }
  friend bool operator==(const ChunkRect&, const ChunkRect&) = default;
};

/// Valid values only: resolution 8, 16, 32 or 64; voxel_size finite and > 0; layers 1 .. 16;
/// bounds not empty and inside `world()`.
struct Grid {
  int resolution = 32;
  double voxel_size = 1;  ///< Map units between voxels.
  int layers = 1;
  std::optional<ChunkRect> bounds;  ///< Nothing exists beyond them; without them, beyond `world()`.

  /// All ground there can be: the same voxels at every resolution.
  ChunkRect world() const {
    const std::int32_t n = kWorldVoxels / resolution;
    return {-n, -n, n, n};
  }
  ChunkRect extent() const { return bounds ? *bounds : world(); }
  /// The column or row of chunks that column or row `voxel` of the map is in.
  std::int32_t chunk_of(std::int32_t voxel) const {
    return voxel / resolution - (voxel % resolution < 0 ? 1 : 0);
  }
};

}  // namespace earthwork::voxel
