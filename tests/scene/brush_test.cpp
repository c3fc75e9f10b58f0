// A brush: where it snaps to, and the outline that shows what it will do.
#include "client/scene/brush.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace earthwork::scene {
namespace {

using protocol::MapPoint;
using protocol::StencilShape;

/// Twice the signed area.
double twice_area(const std::vector<MapPoint>& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MapPoint& a = points[i];
    const MapPoint& b = points[(i + 1) % points.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

TEST(Brush, SnapsToTheNearestVoxel) {
  EXPECT_EQ(snapped({3.2, -0.1}, Snap::centres, 1), (MapPoint{3.5, -0.5}));
  EXPECT_EQ(snapped({3.2, -0.1}, Snap::centres, 2), (MapPoint{3, -1}));
  EXPECT_EQ(snapped({3.5, 7.5}, Snap::centres, 1), (MapPoint{3.5, 7.5}));
}

TEST(Brush, SnapsToTheNearestCornerOfVoxels) {
  EXPECT_EQ(snapped({3.2, -0.6}, Snap::lines, 1), (MapPoint{3, -1}));
  EXPECT_EQ(snapped({3.2, -0.6}, Snap::lines, 0.5), (MapPoint{3, -0.5}));
}

TEST(Brush, WithoutSnappingStaysWhereItIs) {
  EXPECT_EQ(snapped({3.2, -0.6}, Snap::none, 1), (MapPoint{3.2, -0.6}));
}

TEST(Brush, TooSmallToMeetAVoxelForSureSnapsToCentres) {
  EXPECT_EQ(snap_of({.radius_voxels = 0, .snap = Snap::none}), Snap::centres);
  EXPECT_EQ(snap_of({.radius_voxels = 0.49, .snap = Snap::lines}), Snap::centres);
  EXPECT_EQ(snap_of({.radius_voxels = 0.5, .snap = Snap::none}), Snap::none);
  EXPECT_EQ(snap_of({.radius_voxels = 3, .snap = Snap::lines}), Snap::lines);
}

TEST(Brush, ASquaresOutlineIsItsCorners) {
  EXPECT_EQ(outline(StencilShape::square, 2, {10, 20}, 0.1),
            (std::vector<MapPoint>{{8, 18}, {12, 18}, {12, 22}, {8, 22}}));
}

TEST(Brush, OfNoRadiusHasNoOutline) {
  EXPECT_TRUE(outline(StencilShape::circle, 0, {1, 1}, 0.1).empty());
  EXPECT_TRUE(outline(StencilShape::square, 0, {1, 1}, 0.1).empty());
  EXPECT_TRUE(outline(StencilShape::circle, std::nan(""), {1, 1}, 0.1).empty());
}

TEST(Brush, ACircleHas16To256Points) {
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, 5).size(), 16u);
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, 0.001).size(), 71u);
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, 1e-9).size(), 256u);
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, 1e-300).size(), 256u);
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, 0).size(), 256u);
  EXPECT_EQ(outline(StencilShape::circle, 1, {}, std::nan("")).size(), 256u);
}

RC_GTEST_PROP(Brush, AnOutlineStraysNoFurtherThanItMay, ()) {
  const double radius = *rc::gen::inRange(1, 50'000) / 1000.0;
  const double tolerance = radius * *rc::gen::inRange(76, 2000) / 1e6;  // 256 points do from 76 on
  const MapPoint centre{*rc::gen::inRange(-1000, 1000) / 8.0, 5};
  const auto points = outline(StencilShape::circle, radius, centre, tolerance);
  RC_ASSERT(points.size() >= 16u);
  RC_ASSERT(points.size() <= 256u);
  RC_ASSERT(twice_area(points) > 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MapPoint& a = points[i];
    const MapPoint& b = points[(i + 1) % points.size()];
    RC_ASSERT(std::abs(std::hypot(a.x - centre.x, a.y - centre.y) - radius) < 1e-12 * 1000);
    const double middle = std::hypot((a.x + b.x) / 2 - centre.x, (a.y + b.y) / 2 - centre.y);
    // Not many more points than are needed: half as many would stray too far.
    RC_ASSERT(radius - middle <= tolerance * (1 + 1e-6) + 1e-9);
    if (points.size() > 17) RC_ASSERT(4.2 * (radius - middle) > tolerance);
  }
}

}  // namespace
}  // namespace earthwork::scene
