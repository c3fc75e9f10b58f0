// The fold: settings become a grid, edits become stamps.
#include "server/history/fold.hpp"

#include <gtest/gtest.h>

namespace earthwork::history {
namespace {

using protocol::Edit;
using protocol::MapSettings;
using protocol::StencilShape;

Edit disc(double x, double y, double radius) {
  return {.stencil = StencilShape::circle, .radius = radius, .path = {{x, y}}, .stroke = {}};
}

TEST(Fold, MakesTheMapOfTheSettings) {
  MapSettings settings{.chunk_resolution = 16, .chunks = {{-2, -1, 3, 4}}, .voxel_size = 0.5};
  settings.layers.resize(3);
  const voxel::Map map = make_map(settings);
  EXPECT_EQ(map.grid().resolution, 16);
  EXPECT_EQ(map.grid().voxel_size, 0.5);
  EXPECT_EQ(map.grid().layers, 3);
  EXPECT_EQ(map.grid().bounds, (voxel::ChunkRect{-2, -1, 3, 4}));
}

TEST(Fold, WithoutBoundsReachesAsFarAsTheWorld) {
  EXPECT_EQ(make_map({}).grid().bounds, std::nullopt);
}

TEST(Fold, AnEditStampsItsPathInOrder) {
  Edit edit = disc(1, 2, 3);
  edit.fill = false;
  edit.path.push_back({4, 5});
  const auto stamps = stencils(edit);
  ASSERT_EQ(stamps.size(), 2u);
  EXPECT_EQ(stamps[0].x, 1);
  EXPECT_EQ(stamps[0].y, 2);
  EXPECT_EQ(stamps[1].x, 4);
  EXPECT_EQ(stamps[1].y, 5);
  EXPECT_EQ(stamps[1].radius, 3);
  EXPECT_EQ(stamps[1].shape, voxel::Shape::circle);
  EXPECT_EQ(stamps[1].fill, voxel::Fill::empty);
}

TEST(Fold, FillsAndEmpties) {
  voxel::Map map = make_map({});
  apply(map, {.stencil = StencilShape::square, .radius = 2, .path = {{8, 8}}, .stroke = {}});
  EXPECT_EQ(map.filled_voxels(), 16u);  // centres 6.5 .. 9.5 either way
  apply(map, {.stencil = StencilShape::square,
              .fill = false,
              .radius = 1,
              .path = {{8, 8}},
              .stroke = {}});
  EXPECT_EQ(map.filled_voxels(), 12u);
}

TEST(Fold, TellsSquaresFromCircles) {
  voxel::Map map = make_map({});
  apply(map, disc(8, 8, 2));
  EXPECT_EQ(map.filled_voxels(), 12u);  // the square's 16 without its corners
}

TEST(Fold, StampsTheLayerThatIsMeant) {
  MapSettings settings;
  settings.layers.resize(2);
  voxel::Map map = make_map(settings);
  Edit edit = disc(8, 8, 3);
  edit.layer = 1;
  apply(map, edit);
  EXPECT_TRUE(map.filled(1, 8, 8));
  EXPECT_FALSE(map.filled(0, 8, 8));
}

TEST(Fold, AChangeOfLayersGivesALayerOrChangesNoVoxel) {
  voxel::Map map = make_map({});
  history::apply(map, protocol::Action(disc(8, 8, 3)));
  const std::uint64_t hash = map.hash();
  const protocol::LayerChange add, rename{.layer = 0, .name = "a", .color = {}, .wall = {}};
  EXPECT_EQ(history::apply(map, protocol::Action(add)), voxel::Change{});
  EXPECT_EQ(map.grid().layers, 2);
  EXPECT_EQ(history::apply(map, protocol::Action(rename)), voxel::Change{});
  EXPECT_EQ(map.grid().layers, 2);
  EXPECT_EQ(map.hash(), hash);
}

TEST(Fold, APathIsItsStamps) {
  const std::vector<protocol::MapPoint> path{{5, 5}, {9.25, 7}, {30, 33.5}, {31, 33.5}};
  voxel::Map one = make_map({}), many = make_map({});
  Edit edit = disc(0, 0, 2.5);
  edit.path = path;
  apply(one, edit);
  for (const auto& p : path) apply(many, disc(p.x, p.y, 2.5));
  EXPECT_EQ(one.hash(), many.hash());
  EXPECT_GT(one.filled_voxels(), 40u);
}

TEST(Fold, SaysWhatHasToBeMeshedAgain) {
  voxel::Map map = make_map({});
  EXPECT_EQ(apply(map, disc(16, 16, 3)).dirty.size(), 1u);
  EXPECT_EQ(apply(map, disc(32, 32, 3)).dirty.size(), 4u);
  EXPECT_EQ(apply(map, disc(32, 32, 3)).dirty.size(), 0u);
}

}  // namespace
}  // namespace earthwork::history
