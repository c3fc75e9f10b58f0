// The cache of meshes: equal to meshing anew, whenever it is asked.
#include "server/room/mesh_cache.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

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
    cache.put(key, maker.make(key, map.neighbourhood(key), 8, cache.find(key), seq));
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
      fresh.put(key, p.maker.make(key, p.map.neighbourhood(key), 8, nullptr, 1));
    RC_ASSERT(p.cache.totals().hash == fresh.totals().hash);
    RC_ASSERT(p.cache.totals().triangles == fresh.totals().triangles);
    RC_ASSERT(p.cache.totals().bytes == fresh.totals().bytes);
    RC_ASSERT(p.cache.records().size() == fresh.records().size());
  }));
}

}  // namespace
}  // namespace earthwork::room
