// Which voxels a stencil covers, and where it cuts an edge, in numbers worked out by hand.
#include "server/voxel/coverage.hpp"

#include <gtest/gtest.h>

namespace earthwork::voxel {
namespace {

Coverage covering(Shape shape, double x, double y, double radius, Fill fill = Fill::filled) {
  Coverage coverage;
  coverage.assign({.x = x, .y = y, .radius = radius, .shape = shape, .fill = fill}, 1);
  return coverage;
}

TEST(Coverage, OfASquareIncludesItsOutline) {
  const Coverage c = covering(Shape::square, 2.5, 2.5, 1);
  EXPECT_EQ(c.left(), 1);
  EXPECT_EQ(c.right(), 3);
  EXPECT_EQ(c.bottom(), 1);
  EXPECT_EQ(c.top(), 3);
}

TEST(Coverage, OfACircleIncludesItsOutline) {
  const Coverage c = covering(Shape::circle, 0.5, 0.5, 5);
  EXPECT_EQ(c.run(0).first, -5);
  EXPECT_EQ(c.run(0).last, 5);
  EXPECT_EQ(c.run(3).first, -4);  // 3, 4, 5
  EXPECT_EQ(c.run(5).last, 0);
  EXPECT_EQ(c.top(), 5);
}

TEST(Coverage, OfAPointIsTheVoxelThere) {
  EXPECT_EQ(covering(Shape::circle, 3.5, -1.5, 0).bottom(), -2);
  EXPECT_EQ(covering(Shape::square, 3.5, -1.5, 0).left(), 3);
}

TEST(Coverage, BetweenVoxelsIsNothing) {
  EXPECT_TRUE(covering(Shape::circle, 3, 3, 0.7).empty());
  EXPECT_TRUE(covering(Shape::square, 3, 3.5, 0.4).empty());
  EXPECT_FALSE(covering(Shape::square, 3, 3, 0.5).empty());
}

TEST(Coverage, ASquareCutsAtItsSide) {
  const Coverage c = covering(Shape::square, 2.5, 2.5, 1.25);
  EXPECT_EQ(c.cut(Axis::x, 3, 2, End::lower), (Crossing{8192, {32767, 0}}));
  EXPECT_EQ(c.cut(Axis::x, 0, 2, End::upper), (Crossing{24576, {-32767, 0}}));
  EXPECT_EQ(c.cut(Axis::y, 2, 3, End::lower), (Crossing{8192, {0, 32767}}));
}

TEST(Coverage, EmptyingTurnsTheNormal) {
  const Coverage c = covering(Shape::square, 2.5, 2.5, 1.25, Fill::empty);
  EXPECT_EQ(c.cut(Axis::x, 3, 2, End::lower), (Crossing{8192, {-32767, 0}}));
}

TEST(Coverage, ACircleCutsWhereItsOutlineIs) {
  const Coverage c = covering(Shape::circle, 0.5, 0.5, 2.5);  // in row 2: half a chord of 1.5
  EXPECT_EQ(c.cut(Axis::x, 1, 2, End::lower), (Crossing{16384, {19660, 26214}}));
  EXPECT_EQ(c.cut(Axis::x, -2, 2, End::upper), (Crossing{16384, {-19660, 26214}}));
  EXPECT_EQ(c.cut(Axis::y, 2, 1, End::lower), (Crossing{16384, {26214, 19660}}));
}

TEST(Coverage, ACutIsNeverOnAVoxel) {
  EXPECT_EQ(covering(Shape::square, 2.5, 2.5, 1).cut(Axis::x, 3, 2, End::lower).offset, 1);
  EXPECT_EQ(covering(Shape::square, 2.5, 2.5, 1).cut(Axis::x, 0, 2, End::upper).offset, 32767);
}

TEST(Coverage, APointsNormalIsTheEdgesAxis) {
  const Coverage c = covering(Shape::circle, 2.5, 2.5, 0);
  EXPECT_EQ(c.cut(Axis::y, 2, 2, End::lower), (Crossing{1, {0, 32767}}));
  EXPECT_EQ(c.cut(Axis::y, 2, 1, End::upper), (Crossing{32767, {0, -32767}}));
}

// r * r is 0 or a number of few digits for all but the last two.
TEST(Coverage, TheSmallestCirclesHaveUnitNormals) {
  for (const double radius : {5e-324, 1.6e-162, 2.6e-162, 1e-161, 1e-154, 1e-150, 1e-9}) {
    const Coverage c = covering(Shape::circle, 0.5, 0.5, radius);
    EXPECT_EQ(c.cut(Axis::x, 0, 0, End::lower), (Crossing{1, {32767, 0}})) << radius;
    EXPECT_EQ(c.cut(Axis::y, 0, -1, End::upper), (Crossing{32767, {0, -32767}})) << radius;
  }
}

}  // namespace
}  // namespace earthwork::voxel
