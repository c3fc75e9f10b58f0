#include "protocol/chunk_range.hpp"

#include <gtest/gtest.h>

namespace earthwork::protocol {
namespace {

MapSettings map_of(int resolution, double voxel_size = 1) {
  MapSettings settings;
  settings.chunk_resolution = resolution;
  settings.voxel_size = voxel_size;
  return settings;
}

TEST(ChunkRange, CountsWhatItHolds) {
  EXPECT_EQ((ChunkRange{-1, -1, 2, 3}.count()), 12u);
  EXPECT_EQ((ChunkRange{2, 0, 2, 5}.count()), 0u);
  EXPECT_EQ((ChunkRange{3, 0, 2, 5}.count()), 0u);
  EXPECT_EQ((ChunkRange{-125072, -125072, 125072, 125072}.count()), 250144ull * 250144);
}

TEST(ChunkRange, OfAnUnboundedMapIsTheWorld) {
  EXPECT_EQ(map_extent(map_of(64)), (ChunkRange{-15634, -15634, 15634, 15634}));
  EXPECT_EQ(map_extent(map_of(8)), (ChunkRange{-125072, -125072, 125072, 125072}));
}

TEST(ChunkRange, OfVoxelsEndsAtTheNextChunksFirstVoxel) {
  const MapSettings settings = map_of(8);
  EXPECT_EQ(chunks_of_voxels({0, 0, 7.99, 8}, settings), (ChunkRange{0, 0, 1, 2}));
  EXPECT_EQ(chunks_of_voxels({-0.01, -8, 0, 0}, settings), (ChunkRange{-1, -1, 1, 1}));
}

TEST(ChunkRange, OfCellsLiesHalfAVoxelUpAndRight) {
  const MapSettings settings = map_of(8, 2);  // chunk 0's cells reach from 1 to 17
  EXPECT_EQ(chunks_of_cells({1, 1, 16.9, 17}, settings), (ChunkRange{0, 0, 1, 2}));
  EXPECT_EQ(chunks_of_cells({0.9, 1, 1, 1}, settings), (ChunkRange{-1, 0, 1, 1}));
}

TEST(ChunkRange, StaysInsideTheBounds) {
  MapSettings settings = map_of(8);
  settings.chunks = {-1, -1, 2, 2};
  EXPECT_EQ(chunks_of_voxels({-1e300, -1e300, 1e300, 1e300}, settings), (ChunkRange{-1, -1, 2, 2}));
  EXPECT_TRUE(chunks_of_voxels({16, 0, 99, 1}, settings).empty());
  EXPECT_TRUE(chunks_of_voxels({-99, 0, -8.1, 1}, settings).empty());
  EXPECT_TRUE(chunks_of_voxels({0, 1e308, 0, 1e308}, settings).empty());
}

}  // namespace
}  // namespace earthwork::protocol
