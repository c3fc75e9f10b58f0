// Golden pictures of contours. EARTHWORK_UPDATE=1 writes them anew; look at them before you commit.
#include "server/mesh/svg.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/mesh/script_map.hpp"

namespace earthwork::mesh {
namespace {

std::string golden_path(const std::string& name) {
  return std::string(EARTHWORK_SOURCE_DIR) + "/tests/mesh/golden/" + name + ".svg";
}

void expect_golden(const std::string& name, const std::string& text) {
  if (std::getenv("EARTHWORK_UPDATE")) std::ofstream(golden_path(name)) << text;
  std::ifstream in(golden_path(name));
  ASSERT_TRUE(in) << golden_path(name);
  std::stringstream stored;
  stored << in.rdbuf();
  EXPECT_EQ(stored.str(), text) << name << ": look at both, then run with EARTHWORK_UPDATE=1";
}

class Svg : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scripts, Svg,
                         testing::Values("01_sixteen_squares", "07_circles", "13_diagonal_case6",
                                         "24_fill_empty_fill"),
                         [](const auto& name) { return name.param; });

TEST_P(Svg, IsThePictureItWas) {
  const Script script = read_script(GetParam());
  const voxel::Map map = play(script.grid, script.edits);
  expect_golden(GetParam(), contour_svg(map, 0, script.max_feature_angle));
}

TEST(Svg, OfAnEmptyMapIsADocument) {
  const std::string text = contour_svg(voxel::Map(voxel::Grid{}), 0, 135);
  EXPECT_EQ(text.substr(0, 4), "<svg");
  EXPECT_EQ(text.find("<path"), std::string::npos);
}

}  // namespace
}  // namespace earthwork::mesh
