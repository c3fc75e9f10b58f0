// Which edits have to do with each other.
#include "server/voxel/reach.hpp"

#include <gtest/gtest.h>

#include "tests/voxel/random_edits.hpp"

namespace earthwork::voxel {
namespace {

Stencil disc(double x, double y, double radius) {
  return {.x = x, .y = y, .radius = radius, .shape = Shape::circle, .fill = Fill::filled};
}

Reach reach(const Stencil& stencil, int layer = 0,
            const Grid& grid = {.resolution = 8, .bounds = {}}) {
  return {grid, layer, {&stencil, 1}};
}

TEST(Reach, AStencilInsideAChunkReachesThatChunk) {
  EXPECT_EQ(chunks_under({.resolution = 16, .bounds = {}}, disc(8, 8, 3)), (ChunkRect{0, 0, 1, 1}));
  EXPECT_EQ(chunks_under({.resolution = 16, .bounds = {}}, disc(-8, 24, 3)),
            (ChunkRect{-1, 1, 0, 2}));
}

TEST(Reach, BeyondTheBoundsThereIsNothing) {
  const Grid grid{.resolution = 8, .bounds = ChunkRect{0, 0, 4, 4}};
  EXPECT_EQ(chunks_under(grid, disc(16, 16, 100)), (ChunkRect{0, 0, 4, 4}));
  EXPECT_TRUE(chunks_under(grid, disc(16, 100, 8)).empty());
  EXPECT_FALSE(reach(disc(16, 100, 8), 0, grid).meets(reach(disc(16, 100, 8), 0, grid)));
}

TEST(Reach, NeighboursMeetAndOthersDoNot) {
  EXPECT_TRUE(reach(disc(4, 4, 1)).meets(reach(disc(4, 4, 1))));
  EXPECT_TRUE(reach(disc(4, 4, 1)).meets(reach(disc(12, 12, 1))));
  EXPECT_TRUE(reach(disc(4, 4, 1)).meets(reach(disc(-4, 4, 1))));
  EXPECT_FALSE(reach(disc(4, 4, 1)).meets(reach(disc(20, 4, 1))));
  EXPECT_FALSE(reach(disc(4, 4, 1)).meets(reach(disc(4, -12, 1))));
}

TEST(Reach, LayersDoNotMeet) {
  EXPECT_FALSE(reach(disc(4, 4, 1), 0).meets(reach(disc(4, 4, 1), 1)));
}

TEST(Reach, WhatLiesBesideALongPathIsFree) {
  std::vector<Stencil> diagonal;
  for (int i = 0; i < 1024; ++i) diagonal.push_back(disc(8 * i, 8 * i, 1));
  const Reach path({.resolution = 8, .bounds = {}}, 0, diagonal);
  EXPECT_TRUE(path.meets(reach(disc(800, 800, 1))));
  EXPECT_TRUE(path.meets(reach(disc(8184, 8184, 1))));
  EXPECT_FALSE(path.meets(reach(disc(1600, 800, 1))));
  EXPECT_FALSE(reach(disc(0, 8184, 1)).meets(path));
}

RC_GTEST_PROP(Reach, AStencilChangesNoOtherChunks, ()) {
  const Grid grid = *any_grid();
  Map map(grid);
  for (const Stencil& edit : *any_edits(30)) {
    const ChunkRect rect = chunks_under(grid, edit);
    for (const ChunkKey& key : map.apply(0, {&edit, 1}).changed)
      RC_ASSERT(rect.contains(key.x, key.y));
  }
}

RC_GTEST_PROP(Reach, EditsThatDoNotMeetMayComeInEitherOrder, ()) {
  const Grid grid = *any_grid();
  Map one(grid), other(grid);
  for (const Stencil& edit : *any_edits(40)) one.apply(0, {&edit, 1}), other.apply(0, {&edit, 1});
  const auto a = *any_edits(40), b = *any_edits(40);
  RC_PRE(!Reach(grid, 0, a).meets(Reach(grid, 0, b)));
  RC_ASSERT(!Reach(grid, 0, b).meets(Reach(grid, 0, a)));
  const Change a_first = one.apply(0, a), b_second = one.apply(0, b);
  const Change b_first = other.apply(0, b), a_second = other.apply(0, a);
  RC_ASSERT(a_first == a_second);
  RC_ASSERT(b_first == b_second);
  RC_ASSERT(one.hash() == other.hash());
}

}  // namespace
}  // namespace earthwork::voxel
