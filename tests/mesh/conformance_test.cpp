// Every script of tests/conformance gives the figures that an independent implementation found, as
// it is given and cut into other chunks.
#include <gtest/gtest.h>

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
    // Bounds that other chunks do not fill are a different map; unbounded ones are not.
    const auto grid = rechunked(script.grid, resolution);
    if (!grid) continue;
    const voxel::Map map = play(*grid, script.edits);
    expect_figures(count_figures(map, script.max_feature_angle), expected);
  }
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
