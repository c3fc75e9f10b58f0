// What edits would cost as voxels, counted by hand.
#include "client/bot/load_voxels.hpp"

#include <gtest/gtest.h>

namespace earthwork::bot {
namespace {

protocol::Edit circle(double x, double y, double radius, bool fill = true) {
  protocol::Edit edit;
  edit.path = {{.x = x, .y = y}};
  edit.radius = radius;
  edit.fill = fill;
  return edit;
}

protocol::MapSettings resolution(int side) {
  protocol::MapSettings settings;
  settings.chunk_resolution = side;
  return settings;
}

constexpr PaintedSquare kSquare{.x0 = 0, .y0 = 0, .side = 64};

TEST(VoxelBytes, OfOneVoxelAreItsChunkAndFourCrossings) {
  VoxelBytes voxels(resolution(32), kSquare, 3);
  EXPECT_EQ(voxels.add(circle(10.5, 10.5, 0.5)), 32u * 32 / 8 + 4 * 6);
}

TEST(VoxelBytes, OfAnEditThatChangesNothingAreNone) {
  VoxelBytes voxels(resolution(32), kSquare, 3);
  EXPECT_EQ(voxels.add(circle(10.5, 10.5, 3, false)), 0u);
  EXPECT_GT(voxels.add(circle(10.5, 10.5, 3)), 0u);
  EXPECT_EQ(voxels.add(circle(10.5, 10.5, 3)), 0u);
  EXPECT_EQ(voxels.add(circle(10.5, 10.5, 2)), 0u);
}

// A disc of radius 3 around a voxel's centre has rows of 1, 5, 5, 7, 5, 5, 1 voxels: 7 rows and 7
// columns, each with a crossing at either end.
TEST(VoxelBytes, OfADiscAreACrossingAtBothEndsOfEachRowAndColumn) {
  VoxelBytes voxels(resolution(16), kSquare, 3);
  EXPECT_EQ(voxels.add(circle(8.5, 8.5, 3)), 16u * 16 / 8 + 28 * 6);
}

TEST(VoxelBytes, CountEveryChunkThatChangedWithAllItsCrossings) {
  VoxelBytes voxels(resolution(16), kSquare, 3);
  static_cast<void>(voxels.add(circle(4.5, 4.5, 0.5)));
  // Voxels 15 and 16, three crossings each; the left chunk has the four of the first voxel too.
  const std::uint64_t left = 16 * 16 / 8 + (4 + 3) * 6, right = 16 * 16 / 8 + 3 * 6;
  EXPECT_EQ(voxels.add(circle(16, 8.5, 0.5)), left + right);
}

TEST(VoxelBytes, GoDownWhenGroundIsEmptied) {
  VoxelBytes voxels(resolution(32), kSquare, 3);
  static_cast<void>(voxels.add(circle(10.5, 10.5, 3)));
  EXPECT_EQ(voxels.add(circle(10.5, 10.5, 3, false)), 128u);
}

TEST(VoxelBytes, AreThoseOfVoxelsWhateverTheirSize) {
  protocol::MapSettings small = resolution(16);
  small.voxel_size = 0.25;
  VoxelBytes voxels(small, {.x0 = -8, .y0 = -8, .side = 16}, 0.75);
  EXPECT_EQ(voxels.add(circle(-5.875, -5.875, 0.75)), 16u * 16 / 8 + 28 * 6);
}

TEST(VoxelBytes, ReachOverEveryBorderOfTheSquare) {
  VoxelBytes voxels(resolution(8), {.x0 = 8, .y0 = 8, .side = 8}, 20);
  for (const double x : {8.0, 16.0})
    for (const double y : {8.0, 16.0}) EXPECT_GT(voxels.add(circle(x, y, 20)), 0u);
}

TEST(VoxelBytes, HaveAMeanOverAllWalks) {
  const auto mean = [](std::size_t walks, std::uint64_t edits) {
    return mean_voxel_bytes(resolution(32), kSquare, 3, 1, walks, edits);
  };
  EXPECT_EQ(mean(3, 0), 0);
  EXPECT_EQ(mean(0, 100), 0);
  EXPECT_GT(mean(3, 5000), 128);   // a chunk at least, most times
  EXPECT_LT(mean(3, 5000), 6000);  // never more than four busy ones
  EXPECT_EQ(mean(3, 5000), mean(3, 5000));
  EXPECT_NE(mean(3, 5000), mean(4, 5000));
}

}  // namespace
}  // namespace earthwork::bot
