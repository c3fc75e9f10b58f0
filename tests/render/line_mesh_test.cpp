#include "client/viewer/render/line_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/render/drawn_map.hpp"

namespace earthwork::viewer::render {
namespace {

using protocol::MapPoint;

/// 100 x 100 CSS pixels, 10 a voxel, straight down on (0, 0), two pixels to each of them.
Picture from_above() {
  Picture picture = look_at(one_layer(-1, 0), {{0, 0}, 10}, 100, 100);
  picture.pixel_ratio = 2;
  return picture;
}

constexpr double kReach = 2 + 3 + 1;  // half the width, the halo, and a pixel to fade out in

LineMesh line(const Picture& picture, const std::vector<MapPoint>& points, bool closed) {
  LineMesh mesh;
  mesh.add(picture, points, closed, 0, {Color{1, 0.5F, 0, 0.25F}, 4, 3});
  return mesh;
}

/// Of all triangles, pixels squared.
double area(const LineMesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const LineVertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                     &c = mesh.vertices[mesh.indices[i + 2]];
    twice += std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  return twice / 2;
}

TEST(LineMesh, IsAsWideAsItsStyleWhereItStands) {
  const LineMesh mesh = line(from_above(), {{-2, 1}, {3, 1}}, false);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.indices.size(), 6u);
  EXPECT_NEAR(mesh.vertices[0].x, 100 - 40, 1e-3);
  EXPECT_NEAR(mesh.vertices[0].y, 100 + 20 + kReach, 1e-3);
  EXPECT_NEAR(mesh.vertices[3].x, 100 + 60, 1e-3);
  EXPECT_NEAR(mesh.vertices[3].y, 100 + 20 - kReach, 1e-3);
  EXPECT_FLOAT_EQ(mesh.vertices[0].across, kReach);
  EXPECT_FLOAT_EQ(mesh.vertices[3].across, -kReach);
  EXPECT_FLOAT_EQ(mesh.vertices[0].half_width, 2);
  EXPECT_FLOAT_EQ(mesh.vertices[0].halo, 3);
  EXPECT_EQ(mesh.vertices[0].color, (std::array<std::uint8_t, 4>{255, 128, 0, 64}));
}

TEST(LineMesh, MeetsItselfInASquaresCorners) {
  const LineMesh mesh = line(from_above(), {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}, true);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.indices.size(), 4u * 6);
  // A frame: without gaps, and nothing twice.
  const double outer = 80 + 2 * kReach, inner = 80 - 2 * kReach;
  EXPECT_NEAR(area(mesh), outer * outer - inner * inner, 0.1);
}

TEST(LineMesh, RoundsACornerThatWouldBeAThorn) {
  const LineMesh mesh = line(from_above(), {{-3, 0}, {3, 0}, {-3, 0.2}}, false);
  for (const LineVertex& vertex : mesh.vertices) EXPECT_LE(vertex.x, 100 + 60 + kReach + 1e-3);
  EXPECT_GT(mesh.vertices.size(), 12u);
}

TEST(LineMesh, OmitsPointsOnTopOfEachOther) {
  EXPECT_EQ(line(from_above(), {{0, 0}, {0, 0}, {2, 0}, {2, 0}}, false).vertices.size(), 4u);
  EXPECT_TRUE(line(from_above(), {{1, 1}, {1, 1}, {1, 1}}, true).indices.empty());
  EXPECT_TRUE(line(from_above(), {{1, 1}}, true).indices.empty());
  EXPECT_TRUE(line(from_above(), {}, true).indices.empty());
}

TEST(LineMesh, KeepsNothingOfWhatIsFarBesideTheScreen) {
  EXPECT_TRUE(line(from_above(), {{50, 50}, {60, 50}, {60, 60}}, true).indices.empty());
}

TEST(LineMesh, CutsAWorldsBorderNearTheScreen) {
  const double far = 1e6;
  const LineMesh mesh = line(from_above(), {{0, -far}, {far, -far}, {far, far}, {0, far}}, true);
  ASSERT_EQ(mesh.vertices.size(), 4u);  // the one side that is seen
  for (const LineVertex& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.x, 100, kReach + 1e-3);
    EXPECT_LE(std::abs(vertex.y - 100), 200 + 1e-3);
  }
}

TEST(LineMesh, CutsAClosedLineWithoutAGapWhereItBegins) {
  // Begins in the middle of the screen and leaves it on both sides.
  const LineMesh mesh = line(from_above(), {{0, 0}, {40, 0}, {40, 40}, {-40, 40}, {-40, 0}}, true);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  const auto [low, high] =
      std::minmax_element(mesh.vertices.begin(), mesh.vertices.end(),
                          [](const LineVertex& a, const LineVertex& b) { return a.x < b.x; });
  EXPECT_NEAR(low->x, -100, 1e-3);
  EXPECT_NEAR(high->x, 300, 1e-3);
}

TEST(LineMesh, EndsBeforeTheEye) {
  Picture picture = from_above();
  picture.camera.set({{0, 0}, 10, 0, 1.2});
  const LineMesh mesh = line(picture, {{0, 20}, {0, -1000}}, false);
  ASSERT_FALSE(mesh.vertices.empty());
  for (const LineVertex& vertex : mesh.vertices) {
    EXPECT_TRUE(std::isfinite(vertex.x) && std::isfinite(vertex.y));
    EXPECT_LE(std::abs(vertex.y - 100), 300);
  }
}

}  // namespace
}  // namespace earthwork::viewer::render
