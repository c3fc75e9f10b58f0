#include "tests/bench/field_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace earthwork::bench {
namespace {

using voxel::Crossing;

struct Vector {
  double x, y;
};

Vector gradient(const Field& field, std::int64_t x, std::int64_t y) {
  return {double{field.at(x + 1, y)} - double{field.at(x - 1, y)},
          double{field.at(x, y + 1)} - double{field.at(x, y - 1)}};
}

// The crossing of the edge from sample (x, y) toward +x or, if `step_y`, +y; its ends differ.
Crossing crossing(const Field& field, std::int64_t x, std::int64_t y, bool step_y) {
  const std::int64_t x1 = x + (step_y ? 0 : 1), y1 = y + (step_y ? 1 : 0);
  const double low = double{field.at(x, y)}, high = double{field.at(x1, y1)};
  const double t = low / (low - high);
  const Vector a = gradient(field, x, y), b = gradient(field, x1, y1);
  Vector n{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
  double length = std::hypot(n.x, n.y);
  if (length == 0) {  // a flat place has no direction but the edge's own
    const double along = low < 0 ? 1 : -1;
    n = step_y ? Vector{0, along} : Vector{along, 0};
    length = 1;
  }
  const auto component = [&](double v) {
    return static_cast<std::int16_t>(std::lround(v / length * voxel::kNormalUnit));
  };
  const double steps = std::floor(t * voxel::kEdgeSteps + 0.5);
  const double inside = std::clamp<double>(steps, 1, voxel::kEdgeSteps - 1);
  return {static_cast<std::uint16_t>(inside), {component(n.x), component(n.y)}};
}

voxel::Chunk make_chunk(const Field& field, const MapSize& size, int cx, int cy) {
  constexpr int side = kBenchResolution;
  voxel::ChunkParts parts;
  parts.resolution = side;
  const int last_x = size.chunks_x * side - 1, last_y = size.chunks_y * side - 1;
  for (int y = 0; y < side; ++y) {
    const auto row = static_cast<std::size_t>(y);
    for (int x = 0; x < side; ++x) {
      const int i = cx * side + x, j = cy * side + y;
      const std::uint64_t bit = std::uint64_t{1} << x;
      const bool inside = field.at(i, j) < 0;
      if (inside) parts.rows[row] |= bit;
      if (i < last_x && inside != (field.at(i + 1, j) < 0)) {
        parts.x_masks[row] |= bit;
        parts.x.push_back(crossing(field, i, j, false));
      }
      if (j < last_y && inside != (field.at(i, j + 1) < 0)) {
        parts.y_masks[row] |= bit;
        parts.y.push_back(crossing(field, i, j, true));
      }
    }
  }
  return voxel::Chunk::assemble(parts);
}

}  // namespace

std::uint64_t MapSize::voxels() const {
  constexpr std::uint64_t area = kBenchResolution * kBenchResolution;
  return static_cast<std::uint64_t>(chunks_x) * static_cast<std::uint64_t>(chunks_y) * area;
}

std::uint64_t MapSize::cells() const {
  return static_cast<std::uint64_t>(chunks_x * kBenchResolution - 1) *
         static_cast<std::uint64_t>(chunks_y * kBenchResolution - 1);
}

MapSize size_of(const Field& field) {
  return {static_cast<int>(field.nx) / kBenchResolution,
          static_cast<int>(field.ny) / kBenchResolution};
}

voxel::Map make_map(const Field& field) {
  const MapSize size = size_of(field);
  assert(size.chunks_x > 0 && size.chunks_y > 0 && field.nz == 1);
  voxel::Grid grid;
  grid.resolution = kBenchResolution;
  grid.bounds = voxel::ChunkRect{0, 0, size.chunks_x, size.chunks_y};
  voxel::Map map(grid);
  for (int cy = 0; cy < size.chunks_y; ++cy) {
    for (int cx = 0; cx < size.chunks_x; ++cx) {
      map.put({0, cx, cy, 0}, make_chunk(field, size, cx, cy));
    }
  }
  return map;
}

}  // namespace earthwork::bench
