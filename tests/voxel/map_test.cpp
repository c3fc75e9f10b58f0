// The packed map against the rules written down plainly, and what an edit says it changed.
#include "server/voxel/map.hpp"

#include <gtest/gtest.h>

#include "tests/voxel/random_edits.hpp"
#include "tests/voxel/reference_map.hpp"

namespace earthwork::voxel {
namespace {

constexpr Stencil kDisc{
    .x = 3.5, .y = 3.5, .radius = 2, .shape = Shape::circle, .fill = Fill::filled};

Map played(const Grid& grid, const std::vector<Stencil>& edits) {
  Map map(grid);
  for (const Stencil& edit : edits) map.apply(0, {&edit, 1});
  return map;
}

ReferenceMap::Edges edges(const Map& map, Axis axis) {
  ReferenceMap::Edges found;
  const int r = map.grid().resolution;
  for (const ChunkKey& key : map.keys()) {
    const Chunk& chunk = *map.find(key);
    for (int y = 0; y < r; ++y) {
      std::size_t k = 0;
      const auto row = chunk.crossings(axis, y);
      for (int x = 0; x < r; ++x) {
        if ((chunk.mask(axis, y) >> x & 1) == 0) continue;
        found[{key.x * r + x, key.y * r + y}] = row[k++];
      }
      EXPECT_EQ(k, row.size());
    }
  }
  return found;
}

std::set<ReferenceMap::Voxel> voxels(const Map& map) {
  std::set<ReferenceMap::Voxel> found;
  const int r = map.grid().resolution;
  for (const ChunkKey& key : map.keys()) {
    for (int k = 0; k < r * r; ++k) {
      if (map.find(key)->filled(k % r, k / r)) found.insert({key.x * r + k % r, key.y * r + k / r});
    }
  }
  return found;
}

void check_rules(const Grid& grid, const std::vector<Stencil>& edits) {
  const Map map = played(grid, edits);
  ReferenceMap reference(grid);
  for (const Stencil& edit : edits) reference.apply(edit);
  RC_ASSERT(voxels(map) == reference.voxels());
  RC_ASSERT(edges(map, Axis::x) == reference.edges(true));
  RC_ASSERT(edges(map, Axis::y) == reference.edges(false));
}

TEST(Map, GrowsByALayerThatHoldsNothing) {
  Map map(Grid{.layers = 1, .bounds = {}});
  map.apply(0, {&kDisc, 1});
  const std::uint64_t hash = map.hash();
  map.set_layers(2);
  EXPECT_EQ(map.grid().layers, 2);
  EXPECT_EQ(map.hash(), hash);
  EXPECT_FALSE(map.filled(1, 3, 3));
  map.apply(1, {&kDisc, 1});
  EXPECT_TRUE(map.filled(1, 3, 3));
  EXPECT_NE(map.hash(), hash);
}

TEST(Map, ForgetsWhatALayerHeldThatGoes) {
  Map map(Grid{.layers = 1, .bounds = {}});
  map.apply(0, {&kDisc, 1});
  const std::uint64_t hash = map.hash();
  map.set_layers(3);
  map.apply(1, {&kDisc, 1});
  map.apply(2, {&kDisc, 1});
  static_cast<void>(map.hash());
  map.apply(2, {&kDisc, 1});
  map.set_layers(1);
  EXPECT_EQ(map.hash(), hash);
  EXPECT_EQ(map.keys().back().layer, 0);
  map.set_layers(2);
  EXPECT_FALSE(map.filled(1, 3, 3));
}

RC_GTEST_PROP(Map, FollowsTheRulesOneVoxelAtATime, ()) { check_rules(*any_grid(), *any_edits(12)); }

RC_GTEST_PROP(Map, FollowsTheRulesAtAnotherVoxelSize, ()) {
  const double voxel_size = *rc::gen::element(0.1, 0.3, 2.5, 1000.0);
  check_rules({.resolution = 16, .voxel_size = voxel_size, .bounds = {}},
              *any_edits(12, voxel_size));
}

RC_GTEST_PROP(Map, ARepeatedEditChangesNothing, ()) {
  Map map = played(*any_grid(), *any_edits(12));
  const Stencil edit = *any_stencil(12);
  map.apply(0, {&edit, 1});
  const Change& again = map.apply(0, {&edit, 1});
  RC_ASSERT(again.changed.empty());
  RC_ASSERT(again.dirty.empty());
}

RC_GTEST_PROP(Map, APathIsItsStampsInOneChange, ()) {
  const Grid grid = *any_grid();
  const auto path = *any_edits(12);
  Map whole(grid), single(grid);
  const Change change = whole.apply(0, path);
  std::set<ChunkKey> changed;
  for (const Stencil& stamp : path) {
    for (const ChunkKey& key : single.apply(0, {&stamp, 1}).changed) changed.insert(key);
  }
  RC_ASSERT(whole.hash() == single.hash());
  RC_ASSERT(std::set(change.changed.begin(), change.changed.end()) == changed);
  RC_ASSERT(change.changed.size() == changed.size());
}

RC_GTEST_PROP(Map, ChunksAreNamedTopRightToBottomLeft, ()) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Change& change = map.apply(0, *any_edits(30));
  const auto before = [](const ChunkKey& a, const ChunkKey& b) {
    return a.y > b.y || (a.y == b.y && a.x > b.x);
  };
  for (std::size_t k = 1; k < change.changed.size(); ++k) {
    RC_ASSERT(before(change.changed[k - 1], change.changed[k]));
  }
  for (std::size_t k = 1; k < change.dirty.size(); ++k) {
    RC_ASSERT(before(change.dirty[k - 1].key, change.dirty[k].key));
  }
}

RC_GTEST_PROP(Map, TheHashIsKeptUpToDate, ()) {
  const Grid grid = *any_grid();
  Map map(grid);
  for (const Stencil& edit : *any_edits(12)) {
    map.apply(0, {&edit, 1});
    if (*rc::gen::arbitrary<bool>()) map.hash();
  }
  Map copy(grid);
  for (const ChunkKey& key : map.keys()) {
    ChunkParts parts;
    parts.resolution = grid.resolution;
    const Chunk& chunk = *map.find(key);
    for (int y = 0; y < grid.resolution; ++y) {
      const auto k = static_cast<std::size_t>(y);
      parts.rows[k] = chunk.row(y);
      parts.x_masks[k] = chunk.mask(Axis::x, y), parts.y_masks[k] = chunk.mask(Axis::y, y);
      for (const Crossing& c : chunk.crossings(Axis::x, y)) parts.x.push_back(c);
      for (const Crossing& c : chunk.crossings(Axis::y, y)) parts.y.push_back(c);
    }
    copy.put(key, Chunk::assemble(parts));
  }
  RC_ASSERT(map.hash() == copy.hash());
  RC_ASSERT(map.filled_voxels() == copy.filled_voxels());
}

TEST(Map, StartsEmptyWithHashZero) {
  Map map(Grid{});
  EXPECT_EQ(map.hash(), 0u);
  EXPECT_EQ(map.chunk_count(), 0u);
}

TEST(Map, ForgetsAChunkThatHoldsNothing) {
  Map map(Grid{});
  map.apply(0, {&kDisc, 1});
  EXPECT_EQ(map.chunk_count(), 1u);
  EXPECT_NE(map.hash(), 0u);
  Stencil bite = kDisc;
  bite.fill = Fill::empty, bite.radius = 3;
  map.apply(0, {&bite, 1});
  EXPECT_EQ(map.chunk_count(), 0u);
  EXPECT_EQ(map.hash(), 0u);
}

TEST(Map, AFirstVoxelMarksTheCellsOfFourChunks) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Stencil dot{
      .x = 8.5, .y = 8.5, .radius = 0.25, .shape = Shape::square, .fill = Fill::filled};
  const Change& change = map.apply(0, {&dot, 1});
  const std::vector<ChunkKey> changed{{0, 1, 1, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}};
  EXPECT_EQ(change.changed, changed);
  ASSERT_EQ(change.dirty.size(), 4u);
  EXPECT_EQ(change.dirty[0].key, (ChunkKey{0, 1, 1, 0}));
  EXPECT_EQ(change.dirty[0].cells, (CellRect{0, 0, 1, 1}));
  EXPECT_EQ(change.dirty[1].key, (ChunkKey{0, 0, 1, 0}));
  EXPECT_EQ(change.dirty[1].cells, (CellRect{7, 0, 8, 1}));
  EXPECT_EQ(change.dirty[2].key, (ChunkKey{0, 1, 0, 0}));
  EXPECT_EQ(change.dirty[2].cells, (CellRect{0, 7, 1, 8}));
  EXPECT_EQ(change.dirty[3].key, (ChunkKey{0, 0, 0, 0}));
  EXPECT_EQ(change.dirty[3].cells, (CellRect{7, 7, 8, 8}));
}

TEST(Map, AnInnerVoxelMarksItsFourCellsOnly) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Stencil dot{.x = 3.5, .y = 4.5, .radius = 0, .shape = Shape::circle, .fill = Fill::filled};
  const Change& change = map.apply(0, {&dot, 1});
  ASSERT_EQ(change.dirty.size(), 1u);
  EXPECT_EQ(change.dirty[0].cells, (CellRect{2, 3, 4, 5}));
}

// In the row 1.5 above its centre the circle is as wide as the square: 2 to either side.
TEST(Map, AnEqualCutKeepsTheOldNormal) {
  Map map(Grid{});
  const Stencil square{.x = 8, .y = 8, .radius = 2, .shape = Shape::square, .fill = Fill::filled};
  const Stencil circle{.x = 8, .y = 8, .radius = 2.5, .shape = Shape::circle, .fill = Fill::filled};
  map.apply(0, {&square, 1});
  const Crossing before = edges(map, Axis::x).at({9, 9});
  EXPECT_EQ(before, (Crossing{16384, {32767, 0}}));
  map.apply(0, {&circle, 1});
  EXPECT_EQ(edges(map, Axis::x).at({9, 9}), before);
  EXPECT_EQ(edges(map, Axis::x).at({9, 8}).offset, 31113);  // sqrt(6) - 1.5 of an edge: further out
}

TEST(Map, LayersDoNotMeet) {
  Map map(Grid{.layers = 2, .bounds = {}});
  map.apply(1, {&kDisc, 1});
  EXPECT_FALSE(map.filled(0, 3, 3));
  EXPECT_TRUE(map.filled(1, 3, 3));
  const std::uint64_t upper = map.hash();
  Map other(Grid{.layers = 2, .bounds = {}});
  other.apply(0, {&kDisc, 1});
  EXPECT_NE(other.hash(), upper);
}

TEST(Map, ReachesAMillionVoxelsEitherWay) {
  for (const int resolution : {8, 16, 32, 64}) {
    Map map(Grid{.resolution = resolution, .bounds = {}});
    for (const double at : {1000000.5, -999999.5}) {
      const Stencil dot{
          .x = at, .y = -at + 1, .radius = 0.4, .shape = Shape::circle, .fill = Fill::filled};
      map.apply(0, {&dot, 1});
    }
    EXPECT_TRUE(map.filled(0, 1000000, -1000000));
    EXPECT_TRUE(map.filled(0, -1000000, 1000000));
    EXPECT_EQ(map.filled_voxels(), 2u);
  }
}

TEST(Map, TheWorldEndsAlikeForChunksOfAnySize) {
  const Stencil last{
      .x = 1e6, .y = -1e6, .radius = 512, .shape = Shape::circle, .fill = Fill::filled};
  Map small(Grid{.resolution = 8, .bounds = {}}), large(Grid{.resolution = 64, .bounds = {}});
  small.apply(0, {&last, 1});
  large.apply(0, {&last, 1});
  EXPECT_EQ(small.filled_voxels(), large.filled_voxels());
  EXPECT_TRUE(large.filled(0, 1000511, -1000000));
  EXPECT_TRUE(large.filled(0, 1000000, -1000512));
}

TEST(Map, NothingIsKeptBeyondTheBounds) {
  Map map(Grid{.resolution = 8, .bounds = ChunkRect{0, 0, 1, 1}});
  const Stencil big{.x = 4, .y = 4, .radius = 100, .shape = Shape::square, .fill = Fill::filled};
  map.apply(0, {&big, 1});
  EXPECT_EQ(map.chunk_count(), 1u);
  EXPECT_EQ(map.filled_voxels(), 64u);
  EXPECT_TRUE(map.find({0, 0, 0, 0})->uniform());  // no crossing on an edge across the border
}

TEST(Map, AUniformChunkCostsLessThanAHundredBytes) {
  Map map(Grid{.resolution = 64, .bounds = ChunkRect{0, 0, 16, 16}});
  const Stencil all{
      .x = 512, .y = 512, .radius = 512, .shape = Shape::square, .fill = Fill::filled};
  map.apply(0, {&all, 1});
  EXPECT_EQ(map.chunk_count(), 256u);
  EXPECT_LT(map.memory_bytes() - Map(Grid{}).memory_bytes(), 256u * 100);
}

TEST(Map, ChunksThatMayHaveAMeshReachDownAndLeft) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Stencil dot{
      .x = 8.5, .y = 8.5, .radius = 0.25, .shape = Shape::square, .fill = Fill::filled};
  map.apply(0, {&dot, 1});
  EXPECT_EQ(map.chunk_count(), 3u);  // the lower left one holds neither voxel nor crossing
  const auto keys = map.meshed_keys();
  EXPECT_NE(std::find(keys.begin(), keys.end(), ChunkKey{0, 0, 0, 0}), keys.end());
}

}  // namespace
}  // namespace earthwork::voxel
