#include "server/mesh/figures.hpp"

#include <bit>
#include <cmath>

#include "server/mesh/chunk_cells.hpp"

namespace earthwork::mesh {
namespace {

constexpr double kStep = voxel::kEdgeSteps;

struct Count {
  Figures figures;
  double length = 0;             // in 1/32768 voxel
  std::uint64_t twice_area = 0;  // of mixed cells, in the square of that
  std::int64_t limit = 0;

  void section(CellPoint a, CellPoint b) {
    const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
    length += std::sqrt(dx * dx + dy * dy);
    ++figures.wall_sections;
    if (a == b) ++figures.degenerate_wall_sections;
  }

  void cell(const ChunkCells& cells, const MixedCell& at) {
    const CellHits hits = cells.hits(at);
    const CellContour pieces = contour(at.cell_case, hits, limit);
    ++figures.cells_by_case[at.cell_case];
    figures.diagonal_connections += pieces.connected ? 1 : 0;
    figures.clamped_features += static_cast<std::uint64_t>(pieces.clamped_features);
    twice_area += static_cast<std::uint64_t>(twice_cell_area(at.cell_case, hits, pieces));
    for (int k = 0; k < pieces.count; ++k) {
      const Piece& piece = pieces.pieces[static_cast<std::size_t>(k)];
      const CellPoint from = place(piece.from, hits[piece.from]);
      const CellPoint to = place(piece.to, hits[piece.to]);
      if (!piece.feature) {
        section(from, to);
        continue;
      }
      ++figures.sharp_features;
      section(from, *piece.feature);
      section(*piece.feature, to);
    }
  }

  void chunk(const ChunkCells& cells) {
    for (int y = 0; y < cells.height(); ++y) {
      const auto full = static_cast<std::uint64_t>(std::popcount(cells.full(y)));
      figures.cells_by_case[15] += full;
      if (cells.mixed(y) == 0) continue;
      cells.walk_row(y, [&](const MixedCell& at) { cell(cells, at); });
    }
  }
};

std::uint64_t cells_of(const voxel::ChunkRect& rect, int resolution) {
  const auto side = [&](std::int32_t from, std::int32_t to) {
    return static_cast<std::uint64_t>(to - from) * static_cast<std::uint64_t>(resolution) - 1;
  };
  return side(rect.x0, rect.x1) * side(rect.y0, rect.y1);
}

}  // namespace

Figures count_figures(const voxel::Map& map, double max_feature_angle) {
  const voxel::Grid& grid = map.grid();
  Count count;
  count.limit = sharpness_limit(max_feature_angle);
  ChunkCells cells;
  std::uint64_t walked = 0;
  for (const voxel::ChunkKey& key : map.meshed_keys()) {
    cells.assign(map.neighbourhood(key), grid.resolution);
    count.chunk(cells);
    walked +=
        static_cast<std::uint64_t>(cells.width()) * static_cast<std::uint64_t>(cells.height());
  }
  Figures& f = count.figures;
  std::uint64_t all = walked;
  if (grid.bounds) {
    all = cells_of(*grid.bounds, grid.resolution) * static_cast<std::uint64_t>(grid.layers);
  }
  f.cells_by_case[0] = all;
  for (std::size_t k = 1; k < 16; ++k) f.cells_by_case[0] -= f.cells_by_case[k];
  const double mixed_area = static_cast<double>(count.twice_area) / 2 / (kStep * kStep);
  f.surface_area =
      (static_cast<double>(f.cells_by_case[15]) + mixed_area) * grid.voxel_size * grid.voxel_size;
  f.wall_length = count.length / kStep * grid.voxel_size;
  f.filled_voxels = map.filled_voxels();
  return f;
}

}  // namespace earthwork::mesh
