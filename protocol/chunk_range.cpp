#include "protocol/chunk_range.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/limits.hpp"

namespace earthwork::protocol {
namespace {

/// The chunk that `voxels` falls into, `low` or `high` when it lies beyond them. Compared as
/// float64, so that no coordinate is too large to be converted.
std::int32_t chunk_at(double voxels, int resolution, std::int32_t low, std::int32_t high) {
  const double chunk = std::floor(voxels / resolution);
  return static_cast<std::int32_t>(std::clamp<double>(chunk, low, high));
}

ChunkRange meeting(const MapRect& rect, const MapSettings& settings, double shift_voxels) {
  const ChunkRange map = map_extent(settings);
  const auto voxels = [&](double at) { return at / settings.voxel_size - shift_voxels; };
  const int r = settings.chunk_resolution;
  // One chunk beyond either end stands for "outside" until the intersection.
  const ChunkRange range{
      chunk_at(voxels(rect.x0), r, map.x0, map.x1),
      chunk_at(voxels(rect.y0), r, map.y0, map.y1),
      chunk_at(voxels(rect.x1), r, map.x0 - 1, map.x1) + 1,
      chunk_at(voxels(rect.y1), r, map.y0 - 1, map.y1) + 1,
  };
  return intersection(range, map);
}

}  // namespace

std::uint64_t ChunkRange::count() const {
  if (empty()) return 0;
  const auto side = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::uint64_t>(std::int64_t{to} - from);
  };
  return side(x0, x1) * side(y0, y1);
}

ChunkRange intersection(const ChunkRange& a, const ChunkRange& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

ChunkRange map_extent(const MapSettings& settings) {
  if (settings.chunks) {
    const auto& c = *settings.chunks;
    return {c[0], c[1], c[2], c[3]};
  }
  const std::int32_t n = kWorldVoxels / settings.chunk_resolution;
  return {-n, -n, n, n};
}

ChunkRange chunks_of_voxels(const MapRect& rect, const MapSettings& settings) {
  return meeting(rect, settings, 0);
}

ChunkRange chunks_of_cells(const MapRect& rect, const MapSettings& settings) {
  return meeting(rect, settings, 0.5);
}

}  // namespace earthwork::protocol
