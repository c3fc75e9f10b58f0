#include <gtest/gtest.h>

#include "protocol/edit.hpp"

namespace earthwork::protocol {
namespace {

Edit stamp(double x, double y, double radius) {
  Edit edit;
  edit.path = {{x, y}};
  edit.radius = radius;
  return edit;
}

/// `count` stamps, `step` to the right of one another.
Edit row(int count, double step, double radius) {
  Edit edit = stamp(0, 0, radius);
  edit.is_path = true;
  for (int i = 1; i < count; ++i) edit.path.push_back({i * step, 0});
  return edit;
}

MapSettings map_of(int resolution, double voxel_size = 1) {
  MapSettings settings;
  settings.chunk_resolution = resolution;
  settings.voxel_size = voxel_size;
  return settings;
}

std::string verdict(const Edit& edit, const MapSettings& settings) {
  const auto checked = check_edit(edit, settings);
  if (checked) return "good";
  return std::string(name(checked.error().code)) + ": " + checked.error().detail;
}

TEST(EditLimits, KnowTheMapsLayers) {
  MapSettings settings = map_of(32);
  Edit edit = stamp(0, 0, 1);
  edit.layer = 1;
  EXPECT_EQ(verdict(edit, settings), "out_of_range: layer: 1 is outside 0 .. 0");
  settings.layers.resize(2);
  EXPECT_EQ(verdict(edit, settings), "good");
}

TEST(EditLimits, CountTheRadiusInVoxels) {
  EXPECT_EQ(verdict(stamp(0, 0, 512), map_of(64)), "good");
  EXPECT_EQ(verdict(stamp(0, 0, 600), map_of(64)),
            "out_of_range: radius: 600 voxels is beyond the limit of 512");
  EXPECT_EQ(verdict(stamp(0, 0, 600), map_of(64, 2)), "good");
  EXPECT_EQ(verdict(stamp(0, 0, 256.01), map_of(64, 0.5)),
            "out_of_range: radius: 512.02 voxels is beyond the limit of 512");
  EXPECT_EQ(verdict(stamp(0, 0, 1e308), map_of(64, 1e-6)),
            "out_of_range: radius: inf voxels is beyond the limit of 512");
}

TEST(EditLimits, CountCoordinatesInVoxels) {
  EXPECT_EQ(verdict(stamp(1e6, -1e6, 3), map_of(32)), "good");
  EXPECT_EQ(verdict(stamp(1000000.5, 0, 3), map_of(32)),
            "out_of_range: x: 1000000.5 voxels from 0 is beyond the limit of 1000000");
  EXPECT_EQ(verdict(stamp(0, -501, 0.01), map_of(32, 0.0005)),
            "out_of_range: y: 1002000 voxels from 0 is beyond the limit of 1000000");
  Edit path = row(3, 1, 1);
  path.path[2].x = 2e6;
  EXPECT_EQ(
      verdict(path, map_of(32)),
      "out_of_range: path: element 2 at 2000000 voxels from 0 is beyond the limit of 1000000");
}

TEST(EditLimits, AddUpVoxelVisits) {
  EXPECT_EQ(verdict(row(1024, 0, 63.5), map_of(64)), "good") << "1,024 stamps of 128 x 128";
  EXPECT_EQ(verdict(row(1024, 0, 64), map_of(64)),
            "too_large: path: 17040384 voxel visits are beyond the limit of 16777216");
  EXPECT_EQ(verdict(row(15, 0, 512), map_of(64)), "good");
  EXPECT_EQ(verdict(row(16, 0, 512), map_of(64)),
            "too_large: path: 16810000 voxel visits are beyond the limit of 16777216");
}

TEST(EditLimits, CountTheChunksOfAStamp) {
  // [x - r - 1, x + r + 1] is [-248, 256] at 251: chunks -31 .. 32 of 8 voxels.
  EXPECT_EQ(verdict(stamp(4, 4, 251), map_of(8)), "good") << "64 x 64 chunks";
  EXPECT_EQ(verdict(stamp(4, 4, 251.1), map_of(8)),
            "too_large: radius: 4225 chunks are beyond the limit of 4096");
  EXPECT_EQ(verdict(stamp(0, 0, 512), map_of(32)), "good") << "34 x 34 chunks";
}

TEST(EditLimits, CountNoChunkOutsideTheBounds) {
  MapSettings settings = map_of(8);
  settings.chunks = {0, 0, 64, 64};
  EXPECT_EQ(verdict(stamp(256, 256, 512), settings), "good");
  settings.chunks = {0, 0, 65, 64};
  EXPECT_EQ(verdict(stamp(256, 256, 512), settings),
            "too_large: radius: 4160 chunks are beyond the limit of 4096");
}

TEST(EditLimits, CountAChunkOfALongStrokeOnce) {
  // [-53, 53] is 14 rows of chunks; at the end of the second, x = 4,145 is the 526th column.
  EXPECT_EQ(verdict(row(1024, 1.75, 52), map_of(8)), "good");
  EXPECT_EQ(verdict(row(1024, 4, 52), map_of(8)),
            "too_large: path: 7364 chunks are beyond the limit of 4096");
}

TEST(EditLimits, LetAStrokeGoFarAcross) {
  Edit diagonal = row(1024, 1, 5);
  for (MapPoint& point : diagonal.path) point.y = point.x;
  EXPECT_EQ(verdict(diagonal, map_of(8)), "good") << "the rectangle around it is 130 x 130 chunks";
}

TEST(EditLimits, LetAScribbleGoOverTheSameGround) {
  Edit scribble = row(1024, 0, 20);
  for (std::size_t i = 0; i < scribble.path.size(); ++i) scribble.path[i].x = i % 2 ? 200 : 0;
  EXPECT_EQ(verdict(scribble, map_of(8)), "good");
}

TEST(EditLimits, LetStampsLieFarApart) {
  Edit far = row(2, 0, 20);
  far.path[0] = {-1e6, -1e6};
  far.path[1] = {1e6, 1e6};
  EXPECT_EQ(verdict(far, map_of(8)), "good");
}

}  // namespace
}  // namespace earthwork::protocol
