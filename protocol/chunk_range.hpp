/// Which chunks a rectangle of the map meets: what views and edits are counted in.
#pragma once

#include <cstdint>

#include "protocol/settings.hpp"

namespace earthwork::protocol {

/// A rectangle in map units, x0 <= x1, y0 <= y1; its border belongs to it.
struct MapRect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  friend bool operator==(const MapRect&, const MapRect&) = default;
};

/// Chunks x0 <= x < x1, y0 <= y < y1; none when either pair is empty.
struct ChunkRange {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] std::uint64_t count() const;
  [[nodiscard]] bool contains(std::int32_t x, std::int32_t y) const {
    return x0 <= x && x < x1 && y0 <= y && y < y1;
  }
  friend bool operator==(const ChunkRange&, const ChunkRange&) = default;
};

[[nodiscard]] ChunkRange intersection(const ChunkRange& a, const ChunkRange& b);

/// All chunks a map can have: its bounds, or those within kWorldVoxels of 0.
[[nodiscard]] ChunkRange map_extent(const MapSettings& settings);

/// The chunks of the map whose voxels' squares, [cx R s, (cx + 1) R s) and y alike, meet `rect`.
[[nodiscard]] ChunkRange chunks_of_voxels(const MapRect& rect, const MapSettings& settings);

/// The chunks of the map whose cells, and so their meshes, meet `rect`: cells lie half a voxel to
/// the upper right of the voxels' squares.
[[nodiscard]] ChunkRange chunks_of_cells(const MapRect& rect, const MapSettings& settings);

}  // namespace earthwork::protocol
