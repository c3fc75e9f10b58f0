#include "client/scene/vector.hpp"

#include <gtest/gtest.h>

namespace earthwork::scene {
namespace {

/// Scaled by 2, 3, 4, then moved by (10, 20, 30).
Mat4 scale_and_move() { return {.m = {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1}}; }
/// x becomes y, y becomes -x.
Mat4 quarter_turn() { return {.m = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}; }

TEST(Vector, MatricesAreColumnMajor) {
  EXPECT_EQ(scale_and_move() * Vec3({1, 1, 1}), (std::array<double, 4>{12, 23, 34, 1}));
}

TEST(Vector, AProductAppliesTheRightOneFirst) {
  const Vec3 point{5, 7, 9};
  EXPECT_EQ(quarter_turn() * point, (std::array<double, 4>{-7, 5, 9, 1}));
  const std::array<double, 4> turned_first{-7 * 2 + 10, 5 * 3 + 20, 9 * 4 + 30, 1};
  EXPECT_EQ(scale_and_move() * quarter_turn() * point, turned_first);
  EXPECT_EQ(quarter_turn() * scale_and_move() * point, (std::array<double, 4>{-41, 20, 66, 1}));
}

}  // namespace
}  // namespace earthwork::scene
