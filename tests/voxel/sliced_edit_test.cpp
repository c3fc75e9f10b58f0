// An edit in slices is the edit, whatever happens elsewhere meanwhile.
#include "server/voxel/sliced_edit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "tests/voxel/random_edits.hpp"

namespace earthwork::voxel {
namespace {

constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

Stencil box(double x, double y, double radius, Fill fill = Fill::filled) {
  return {.x = x, .y = y, .radius = radius, .shape = Shape::square, .fill = fill};
}

std::vector<Stencil> row_of_boxes(int count) {
  std::vector<Stencil> path;
  for (int i = 0; i < count; ++i) path.push_back(box(4 + 8 * i, 4, 3));
  return path;
}

TEST(SlicedEdit, ShowsNothingBeforeItIsCommitted) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  SlicedEdit edit(map, 0, row_of_boxes(3));
  ASSERT_TRUE(edit.advance(kAll));
  EXPECT_EQ(map.hash(), 0u);
  EXPECT_EQ(map.chunk_count(), 0u);
  EXPECT_EQ(edit.commit(map).changed.size(), 3u);
  EXPECT_EQ(map.filled_voxels(), 3u * 36);
}

TEST(SlicedEdit, TakesAsManyStampsAsTheVisitsAllow) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  // Each looks at 3 x 3 chunks, as far as the rectangle around it tells.
  SlicedEdit edit(map, 0, std::vector<Stencil>(5, box(4, 4, 4)));
  EXPECT_FALSE(edit.advance(18));  // 2
  EXPECT_FALSE(edit.advance(1));   // 1 at least
  EXPECT_TRUE(edit.advance(10));   // 2
}

TEST(SlicedEdit, OneOfNoStampsIsThroughAtOnce) {
  Map map(Grid{});
  SlicedEdit edit(map, 0, {});
  EXPECT_TRUE(edit.advance(1));
  EXPECT_EQ(edit.commit(map), Change{});
}

TEST(SlicedEdit, AChunkThatItEmptiedStaysEmpty) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Stencil ground = box(4, 4, 3);
  map.apply(0, {&ground, 1});
  // Emptied, then looked at again after stamps elsewhere.
  SlicedEdit edit(map, 0,
                  {box(4, 4, 5, Fill::empty), box(404, 4, 3), box(4.5, 4.5, 0.25), box(404, 4, 3)});
  while (!edit.advance(1)) {
  }
  const Change change = edit.commit(map);
  EXPECT_EQ(map.filled_voxels(), 1u + 36);
  EXPECT_TRUE(map.filled(0, 4, 4));
  ASSERT_EQ(change.changed.size(), 2u);
  EXPECT_EQ(change.changed[0], (ChunkKey{0, 50, 0, 0}));
  EXPECT_EQ(change.changed[1], (ChunkKey{0, 0, 0, 0}));
}

// The ground crosses two borders; the stamp lies in the chunk that owns the edges across them.
TEST(SlicedEdit, SeesTheNeighboursOfTheChunksThatItStamps) {
  for (const auto& [x, y] : {std::pair{8.0, 4.0}, {4.0, 8.0}}) {
    Map map(Grid{.resolution = 8, .bounds = {}}), direct(Grid{.resolution = 8, .bounds = {}});
    const Stencil ground = box(x, y, 3.5), bite = box(x - 3, y - 3, 1, Fill::empty);
    map.apply(0, {&ground, 1}), direct.apply(0, {&ground, 1});
    SlicedEdit edit(map, 0, {bite});
    ASSERT_TRUE(edit.advance(1));
    EXPECT_EQ(edit.commit(map), direct.apply(0, {&bite, 1}));
    EXPECT_EQ(map.hash(), direct.hash());
  }
}

TEST(SlicedEdit, DropsAChunkThatHoldsNothingAfterwards) {
  Map map(Grid{.resolution = 8, .bounds = {}});
  const Stencil ground = box(4, 4, 3);
  map.apply(0, {&ground, 1});
  (void)map.hash();
  SlicedEdit edit(map, 0, {box(4, 4, 4, Fill::empty)});
  ASSERT_TRUE(edit.advance(kAll));
  EXPECT_EQ(edit.commit(map).changed.size(), 1u);
  EXPECT_EQ(map.chunk_count(), 0u);
  EXPECT_EQ(map.hash(), 0u);
}

TEST(SlicedEdit, AnotherLayerIsNotItsConcern) {
  Map map(Grid{.resolution = 8, .layers = 2, .bounds = {}});
  SlicedEdit edit(map, 1, row_of_boxes(2));
  const Stencil below = box(4, 4, 5);
  map.apply(0, {&below, 1});
  ASSERT_TRUE(edit.advance(kAll));
  edit.commit(map);
  EXPECT_EQ(map.filled_voxels(), 100u + 2 * 36);
}

std::vector<Stencil> somewhere(double x, double y) {
  std::vector<Stencil> edits = *any_edits(20);
  for (Stencil& s : edits) s.x += x, s.y += y;
  return edits;
}

bool same_chunks(const Map& a, const Map& b) {
  const auto keys = a.keys();
  return keys == b.keys() && std::all_of(keys.begin(), keys.end(), [&](const ChunkKey& key) {
           return a.find(key)->hash() == b.find(key)->hash();
         });
}

/// In slices of any size, with edits in between that do not meet it: the same chunks, hash and
/// Change as applied directly at the time of its commit; and the others' Changes are the same too.
TEST(SlicedEdit, IsTheEditWhateverComesInBetween) {
  EXPECT_TRUE(rc::check([] {
    Grid grid = *any_grid();
    grid.layers = 2;
    Map sliced(grid), direct(grid);
    // Ground across the borders of chunks of any size.
    auto ground = somewhere(0, 0);
    ground.insert(ground.begin(), box(0.5, 0.5, *rc::gen::inRange(1, 12)));
    for (const Stencil& s : ground) sliced.apply(0, {&s, 1}), direct.apply(0, {&s, 1});
    if (*rc::gen::arbitrary<bool>()) (void)sliced.hash();

    const auto stencils = somewhere(*rc::gen::inRange(-40, 40), *rc::gen::inRange(-40, 40));
    SlicedEdit edit(sliced, 0, stencils);
    bool through = false;
    int let_by = 0;
    while (!through) {
      through = edit.advance(*rc::gen::inRange<std::uint64_t>(0, 40));
      const int layer = *rc::gen::weightedElement<int>({{4, 0}, {1, 1}});
      const auto others = somewhere(*rc::gen::inRange(-90, 90), *rc::gen::inRange(-90, 90));
      if (edit.reach().meets(Reach(grid, layer, others))) continue;
      RC_ASSERT(sliced.apply(layer, others) == direct.apply(layer, others));
      RC_ASSERT(sliced.hash() == direct.hash());
      ++let_by;
    }
    RC_TAG(let_by > 0);
    RC_ASSERT(edit.commit(sliced) == direct.apply(0, stencils));
    RC_ASSERT(same_chunks(sliced, direct));
    RC_ASSERT(sliced.hash() == direct.hash());

    // And the map goes on as if nothing had been.
    const auto later = somewhere(0, 0);
    RC_ASSERT(sliced.apply(0, later) == direct.apply(0, later));
    RC_ASSERT(sliced.hash() == direct.hash());
  }));
}

}  // namespace
}  // namespace earthwork::voxel
