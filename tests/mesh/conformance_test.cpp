// Every script of tests/conformance gives the figures that an independent implementation found, as
// it is given and cut into other chunks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/figures.hpp"
#include "server/mesh/mesher.hpp"
#include "tests/mesh/script_map.hpp"

namespace earthwork::mesh {
namespace {

constexpr int kResolutions[] = {8, 16, 32, 64};

std::vector<std::string> script_names() {
  std::vector<std::string> names;
  const nlohmann::json expected = read_expected();
  for (const auto& [name, figures] : expected.items()) names.push_back(name);
  return names;
}

class Conformance : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scripts, Conformance, testing::ValuesIn(script_names()),
                         [](const auto& name) { return name.param; });

void expect_figures(const Figures& f, const nlohmann::json& expected) {
  const double area = expected["surface_area"], length = expected["wall_length"];
  EXPECT_NEAR(f.surface_area, area, 1e-6 * area);
  EXPECT_NEAR(f.wall_length, length, 1e-6 * length);
  EXPECT_EQ(f.wall_sections, expected["wall_sections"]);
  EXPECT_EQ(f.degenerate_wall_sections, expected["degenerate_wall_sections"]);
  EXPECT_EQ(f.sharp_features, expected["sharp_features"]);
  EXPECT_EQ(f.clamped_features, expected["clamped_features"]);
  EXPECT_EQ(f.diagonal_connections, expected["diagonal_connections"]);
  EXPECT_EQ(f.filled_voxels, expected["filled_voxels"]);
  for (std::size_t k = 0; k < 16; ++k) {
    EXPECT_EQ(f.cells_by_case[k], expected["cells_by_case"][std::to_string(k)]) << "case " << k;
  }
}

TEST_P(Conformance, FiguresAreTheReferences) {
  const Script script = read_script(GetParam());
  const nlohmann::json expected = read_expected()[GetParam()];
  EXPECT_EQ(script.edits.size(), expected["edits"]);
  const voxel::Map map = play(script.grid, script.edits);
  expect_figures(count_figures(map, script.max_feature_angle), expected);
}

TEST_P(Conformance, ChunkSizeDoesNotShow) {
  const Script script = read_script(GetParam());
  const nlohmann::json expected = read_expected()[GetParam()];
  for (const int resolution : kResolutions) {
    SCOPED_TRACE(resolution);
    // Bounds that other chunks cannot fill are another map; the test below has none.
    const auto grid = rechunked(script.grid, resolution);
    if (!grid) continue;
    const voxel::Map map = play(*grid, script.edits);
    expect_figures(count_figures(map, script.max_feature_angle), expected);
  }
}

/// Every piece of the contour in 1/32768 voxel of the map: from, feature or from again, to.
std::vector<std::array<std::int64_t, 6>> pieces(const voxel::Map& map, double max_feature_angle) {
  std::vector<std::array<std::int64_t, 6>> found;
  const std::int64_t limit = sharpness_limit(max_feature_angle);
  ChunkCells cells;
  for (const voxel::ChunkKey& key : map.meshed_keys()) {
    cells.assign(map.neighbourhood(key), map.grid().resolution);
    for (int y = 0; y < cells.height(); ++y) {
      cells.walk_row(y, [&](const MixedCell& cell) {
        const std::int64_t x0 = (key.x * map.grid().resolution + cell.x) * 32768ll;
        const std::int64_t y0 = (key.y * map.grid().resolution + cell.y) * 32768ll;
        const CellHits hits = cells.hits(cell);
        const CellContour inside = contour(cell.cell_case, hits, limit);
        for (int k = 0; k < inside.count; ++k) {
          const Piece& piece = inside.pieces[static_cast<std::size_t>(k)];
          const CellPoint from = place(piece.from, hits[piece.from]);
          const CellPoint tip = piece.feature.value_or(from);
          const CellPoint to = place(piece.to, hits[piece.to]);
          found.push_back({x0 + from.x, y0 + from.y, x0 + tip.x, y0 + tip.y, x0 + to.x, y0 + to.y});
        }
      });
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST_P(Conformance, TheContourIsTheSameInChunksOfAnySize) {
  const Script script = read_script(GetParam());
  const auto in_chunks_of = [&](int resolution) {
    return pieces(play({.resolution = resolution, .bounds = {}}, script.edits),
                  script.max_feature_angle);
  };
  const auto small = in_chunks_of(8);
  EXPECT_GT(small.size(), 10u);
  for (const int resolution : {16, 32, 64})
    EXPECT_EQ(in_chunks_of(resolution), small) << resolution;
}

TEST_P(Conformance, TheMeshHasTheFiguresArea) {
  const Script script = read_script(GetParam());
  for (const int resolution : kResolutions) {
    const voxel::Grid grid{.resolution = resolution, .bounds = {}};
    const voxel::Map map = play(grid, script.edits);
    Mesher mesher(script.max_feature_angle);
    ChunkMesh mesh;
    std::uint64_t twice = 0;
    for (const voxel::ChunkKey& key : map.meshed_keys()) {
      mesher.mesh(map.neighbourhood(key), resolution, mesh);
      twice += twice_area(mesh);
    }
    const double area = count_figures(map, script.max_feature_angle).surface_area;
    EXPECT_DOUBLE_EQ(static_cast<double>(twice) / 2 / 32768 / 32768, area) << resolution;
  }
}

}  // namespace
}  // namespace earthwork::mesh
