// The cache of meshes: equal to meshing anew, whenever it is asked.
#include "server/room/mesh_cache.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <tuple>
#include <utility>
#include <vector>

#include "server/history/fold.hpp"
#include "server/room/mesh_maker.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

struct Painted {
  voxel::Map map = history::make_map({.chunk_resolution = 8, .chunks = {}});
  MeshCache cache;
  MeshMaker maker{135};
  std::uint64_t seq = 0;

  void edit(const protocol::Edit& edit) {
    std::vector<voxel::ChunkKey> keys;
    for (const auto& dirty : history::apply(map, edit).dirty) keys.push_back(dirty.key);
    cache.mark_stale(keys);
    ++seq;
  }
  void make(const voxel::ChunkKey& key) {
    cache.put(key, maker.make(key, map.neighbourhood(key), 8, cache.forerunner(key, seq)));
  }
  void make_some(std::size_t most) {
    for (const voxel::ChunkKey& key : cache.some_stale(most)) make(key);
  }
  /// The chunk's mesh, up to date.
  const CachedMesh* at(std::int32_t x, std::int32_t y) {
    if (cache.stale({0, x, y})) make({0, x, y});
    return cache.find({0, x, y});
  }
};

TEST(MeshCache, HasNothingOfAnEmptyMap) {
  Painted p;
  EXPECT_EQ(p.at(0, 0), nullptr);
  EXPECT_EQ(p.cache.stale_count(), 0u);
  EXPECT_TRUE(p.cache.some_stale(9).empty());
  EXPECT_EQ(p.cache.totals(), MeshTotals{});
}

TEST(MeshCache, KnowsWhatIsNotUpToDate) {
  Painted p;
  p.edit(box(8, 8, 4));
  EXPECT_EQ(p.cache.stale_count(), 4u);
  EXPECT_EQ(p.cache.totals().chunks, 0u);
  EXPECT_EQ(p.cache.count(), 4u);
  EXPECT_EQ(p.cache.find({0, 0, 0}), nullptr);
  p.make({0, 0, 0});
  EXPECT_FALSE(p.cache.stale({0, 0, 0}));
  EXPECT_TRUE(p.cache.stale({0, 1, 0}));
  EXPECT_EQ(p.cache.totals().chunks, 1u);
  EXPECT_EQ(p.cache.some_stale(2).size(), 2u);
  EXPECT_EQ(p.cache.some_stale(9).size(), 3u);
  p.make_some(9);
  EXPECT_EQ(p.cache.stale_count(), 0u);
  EXPECT_EQ(p.cache.totals().chunks, 4u);
  EXPECT_EQ(p.cache.count(), 4u);
}

TEST(MeshCache, MeshesTheGapCellsOfAChunkThatHoldsNothing) {
  Painted p;
  p.edit(box(8.5, 4, 0.5));  // the first voxel column of chunk 1
  EXPECT_EQ(p.map.find({0, 0, 0, 0}) == nullptr, false);
  const CachedMesh* left = p.at(0, 0);
  ASSERT_NE(left, nullptr);
  EXPECT_GT(left->triangles, 0u);
}

TEST(MeshCache, AnUnchangedMeshKeepsItsBytesAndRevision) {
  Painted p;
  p.edit(box(4, 4, 2));
  const RecordBytes before = p.at(0, 0)->bytes;
  p.edit(box(4, 4, 1, false));
  p.edit(box(4, 4, 2));
  EXPECT_EQ(p.at(0, 0)->bytes, before);
  EXPECT_EQ(p.at(0, 0)->revision, 1u);
}

TEST(MeshCache, AChangedMeshHasTheSeqAsOfWhichItWasSeen) {
  Painted p;
  p.edit(box(4, 4, 2));
  p.edit(box(4, 4, 2.25));
  p.edit(box(40, 40, 2));
  EXPECT_EQ(p.at(0, 0)->revision, 3u);
  EXPECT_EQ(decoded(p.at(0, 0)->bytes).revision, 3u);
}

TEST(MeshCache, RemembersWhatWasRemoved) {
  Painted p;
  p.edit(box(4, 4, 2));
  ASSERT_FALSE(p.at(0, 0)->removed);
  p.edit(box(4, 4, 3, false));
  const CachedMesh* gone = p.at(0, 0);
  ASSERT_NE(gone, nullptr);
  EXPECT_TRUE(gone->removed);
  EXPECT_EQ(gone->revision, 2u);
  EXPECT_FALSE(p.cache.may_have_mesh({0, 0, 0, 0}));
  EXPECT_EQ(p.cache.keys().size(), 1u);
  EXPECT_TRUE(p.cache.records().empty());
  p.edit(box(4, 4, 2));
  EXPECT_EQ(p.at(0, 0)->revision, 3u);
  EXPECT_FALSE(p.at(0, 0)->removed);
}

TEST(MeshCache, HasNeverHeardOfWhatCameAndWentUnseen) {
  Painted p;
  p.edit(box(4, 4, 2));
  p.edit(box(4, 4, 3, false));
  EXPECT_EQ(p.at(0, 0), nullptr);
}

/// A map of three discs, the last of which is gone again, as it is after a start.
struct RestoredCache : testing::Test, Painted {
  RestoredCache() {
    for (const protocol::Edit& edit :
         {disc(4.5, 4.5, 2), disc(36.5, 4.5, 2), disc(68.5, 4.5, 2), disc(68.5, 4.5, 4, false)})
      history::apply(map, edit);
    seq = 10;
    cache.restore(map, ages);
  }
  std::uint64_t revision(std::int32_t x, std::int32_t y) const {
    return cache.forerunner({0, x, y}, 10).revision;
  }
  std::vector<journal::ChunkAge> ages{{{0, 0, 0}, 1}, {{0, 4, 0}, 2}, {{0, 8, 0}, 4}};
};

TEST_F(RestoredCache, AMeshIsAsOldAsTheYoungestThatItsCellsReachInto) {
  ages.push_back({{0, 1, 1}, 6});
  MeshCache other;
  other.restore(map, ages);
  const auto age = [&](std::int32_t x, std::int32_t y) {
    return other.forerunner({0, x, y}, 10).revision;
  };
  EXPECT_EQ(age(0, 0), 6u);  // upper right of it
  EXPECT_EQ(age(1, 0), 6u);
  EXPECT_EQ(age(0, 1), 6u);
  EXPECT_EQ(age(1, 1), 6u);
  EXPECT_EQ(age(-1, 0), 1u);
  EXPECT_EQ(age(0, -1), 1u);
  EXPECT_EQ(age(-1, -1), 1u);
  EXPECT_EQ(age(2, 0), 10u);  // reaches into none: nothing is known of it
  EXPECT_FALSE(other.stale({0, 2, 0}));
  EXPECT_TRUE(other.stale({0, -1, -1}));
}

TEST_F(RestoredCache, NothingIsMadeYetAndOnlyWhatMayHaveAMeshCounts) {
  EXPECT_EQ(cache.totals(), MeshTotals{});
  EXPECT_TRUE(cache.may_have_mesh({0, 0, 0}));
  EXPECT_FALSE(cache.may_have_mesh({0, -1, 0}));  // the disc does not reach there
  EXPECT_FALSE(cache.may_have_mesh({0, 8, 0}));
  EXPECT_EQ(cache.count(), 2u);
  EXPECT_EQ(cache.stale_count(), 12u);
  EXPECT_EQ(cache.keys().size(), 12u);  // whoever claims to have them must hear of the others
  make_some(12);
  EXPECT_EQ(cache.count(), 2u);
  EXPECT_EQ(cache.totals().chunks, 2u);
}

/// What counts is little more than what has a mesh, and nothing less; and how old a mesh is told to
/// be, it was no other one since.
TEST(RestoredCacheOf, AnyMapIsRight) {
  EXPECT_TRUE(rc::check([] {
    Painted p;
    journal::ChunkAges ages;
    const int edits = *rc::gen::inRange(1, 25);
    for (int i = 0; i < edits; ++i) {
      const double x = *rc::gen::inRange(-80, 200) / 8.0, y = *rc::gen::inRange(-80, 200) / 8.0;
      const double radius = *rc::gen::inRange(0, 40) / 8.0;
      const auto change = history::apply(
          p.map, box(x, y, radius, *rc::gen::weightedElement<bool>({{2, true}, {1, false}})));
      ages.changed(change.changed, ++p.seq);
      std::vector<voxel::ChunkKey> dirty;
      for (const auto& chunk : change.dirty) dirty.push_back(chunk.key);
      p.cache.mark_stale(dirty);
      p.make_some(SIZE_MAX);
    }
    MeshCache restored;
    restored.restore(p.map, ages.in_order());
    RC_ASSERT(restored.count() <= p.map.chunk_count() + p.cache.totals().chunks);
    for (const voxel::ChunkKey& key : p.cache.keys()) {
      const CachedMesh* known = p.cache.find(key);
      RC_ASSERT(restored.stale(key));
      RC_ASSERT(known->removed || restored.may_have_mesh(key));
      RC_ASSERT(known->revision <= restored.forerunner(key, p.seq).revision);
    }
    for (const voxel::ChunkKey& key : restored.some_stale(SIZE_MAX))
      restored.put(key,
                   p.maker.make(key, p.map.neighbourhood(key), 8, restored.forerunner(key, p.seq)));
    RC_ASSERT(restored.totals().hash == p.cache.totals().hash);
    RC_ASSERT(restored.count() == p.cache.count());
  }));
}

TEST(RestoredCacheOf, AVoxelInACornerShowsInTheChunkBelowLeft) {
  voxel::Map map = history::make_map({.chunk_resolution = 8, .chunks = {}});
  history::apply(map, box(16.5, 16.5, 0.25));
  ASSERT_EQ(map.find({0, 1, 1}), nullptr);
  MeshCache restored;
  restored.restore(map, std::vector<journal::ChunkAge>{{{0, 2, 2}, 1}});
  EXPECT_TRUE(restored.may_have_mesh({0, 1, 1}));
}

TEST_F(RestoredCache, WhatIsMadeIsAsOldAsItIs) {
  EXPECT_EQ(at(0, 0)->revision, 1u);
  EXPECT_EQ(decoded(at(0, 0)->bytes).revision, 1u);
  EXPECT_EQ(at(4, 0)->revision, 2u);
  edit(disc(4.5, 4.5, 2.5));  // event 11
  EXPECT_EQ(at(0, 0)->revision, 11u);
  EXPECT_EQ(at(0, 0)->base_revision, 1u);
}

TEST_F(RestoredCache, WhatIsGoneIsToldAsOldAsThatIs) {
  ASSERT_NE(at(8, 0), nullptr);
  EXPECT_TRUE(at(8, 0)->removed);
  EXPECT_EQ(at(8, 0)->revision, 4u);
  ASSERT_NE(at(7, 0), nullptr);  // may have had one
  EXPECT_TRUE(at(7, 0)->removed);
  EXPECT_EQ(at(9, 0), nullptr);
}

TEST_F(RestoredCache, WhatIsTouchedBeforeItIsMadeIsNew) {
  edit(disc(4.5, 4.5, 4, false));
  edit(disc(68.5, 4.5, 1));
  EXPECT_TRUE(cache.may_have_mesh({0, 8, 0}));
  EXPECT_TRUE(at(0, 0)->removed);
  EXPECT_EQ(at(0, 0)->revision, 12u);
  EXPECT_FALSE(at(8, 0)->removed);
  EXPECT_EQ(at(8, 0)->revision, 12u);
  EXPECT_FALSE(at(8, 0)->delta);  // what somebody has of it is not known here
}

TEST_F(RestoredCache, OnlyWhatWasTouchedIsDirty) {
  EXPECT_EQ(cache.dirty_count(), 0u);
  EXPECT_GT(cache.stale_count(), 0u);
  cache.mark_stale(std::vector<voxel::ChunkKey>{{0, 0, 0}, {0, 20, 20}});
  cache.mark_stale(std::vector<voxel::ChunkKey>{{0, 0, 0}});
  EXPECT_EQ(cache.dirty_count(), 2u);
  const Forerunner before = cache.forerunner({0, 0, 0}, 10);
  at(0, 0);
  EXPECT_EQ(cache.dirty_count(), 1u);
  cache.take_back({0, 0, 0}, before);
  EXPECT_EQ(cache.dirty_count(), 2u);
  make_some(99);
  EXPECT_EQ(cache.dirty_count(), 0u);
}

TEST_F(RestoredCache, NothingIsBeyondTheBounds) {
  voxel::Map bounded = history::make_map({.chunk_resolution = 8, .chunks = {{0, 0, 4, 4}}});
  MeshCache restored;
  restored.restore(bounded, std::vector<journal::ChunkAge>{{{0, 0, 0}, 1}});
  EXPECT_EQ(restored.keys(), (std::vector<voxel::ChunkKey>{{0, 0, 0, 0}}));
}

TEST_F(RestoredCache, WhatIsTakenBackIsAsItWas) {
  const RecordBytes seen = at(0, 0)->bytes;
  const Forerunner made = cache.forerunner({0, 0, 0}, 10), unmade = cache.forerunner({0, 8, 0}, 10);
  voxel::Map before = map;
  edit(disc(4.5, 4.5, 3)), edit(disc(68.5, 4.5, 2));
  at(0, 0), at(8, 0);
  map = std::move(before), seq = 10;
  cache.take_back({0, 0, 0}, made), cache.take_back({0, 8, 0}, unmade);
  EXPECT_TRUE(cache.stale({0, 0, 0}));
  EXPECT_EQ(at(0, 0)->bytes, seen);
  EXPECT_EQ(at(0, 0)->revision, 1u);
  EXPECT_TRUE(at(8, 0)->removed);
  EXPECT_LE(at(8, 0)->revision, 10u);
  make_some(99);
  MeshCache fresh;
  for (const auto& key : map.meshed_keys())
    fresh.put(key, maker.make(key, map.neighbourhood(key), 8, fresh.forerunner(key, 1)));
  EXPECT_EQ(cache.totals().hash, fresh.totals().hash);
  EXPECT_EQ(cache.totals().chunks, fresh.totals().chunks);
}

/// However edits and questions alternate, the totals are those of a cache that starts anew.
TEST(MeshCache, EndsAsIfEverythingWereMeshedOnce) {
  EXPECT_TRUE(rc::check([] {
    Painted p;
    const int edits = *rc::gen::inRange(1, 20);
    for (int i = 0; i < edits; ++i) {
      const double x = *rc::gen::inRange(0, 200) / 8.0, y = *rc::gen::inRange(0, 200) / 8.0;
      const double radius = *rc::gen::inRange(0, 60) / 8.0;
      p.edit(disc(x, y, radius, *rc::gen::weightedElement<bool>({{2, true}, {1, false}})));
      p.at(*rc::gen::inRange(-1, 4), *rc::gen::inRange(-1, 4));
    }
    p.make_some(SIZE_MAX);

    MeshCache fresh;
    for (const auto& key : p.map.meshed_keys())
      fresh.put(key, p.maker.make(key, p.map.neighbourhood(key), 8, fresh.forerunner(key, 1)));
    RC_ASSERT(p.cache.totals().hash == fresh.totals().hash);
    RC_ASSERT(p.cache.totals().triangles == fresh.totals().triangles);
    RC_ASSERT(p.cache.totals().bytes == fresh.totals().bytes);
    RC_ASSERT(p.cache.records().size() == fresh.records().size());
  }));
}

}  // namespace
}  // namespace earthwork::room
