// Voxels kept for somebody while their map goes on.
#include "server/voxel/kept_neighbourhood.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "tests/voxel/random_edits.hpp"

namespace earthwork::voxel {
namespace {

constexpr Stencil kDisc{8, 8, 5, Shape::circle, Fill::filled};

std::uint64_t hash_of(const Chunk* chunk, int resolution) {
  return chunk ? chunk->hash() : Chunk(resolution).hash();
}

/// What a mesh may depend on.
std::vector<std::uint64_t> hashes(const Neighbourhood& n, int resolution) {
  return {hash_of(n.own, resolution),
          hash_of(n.right, resolution),
          hash_of(n.upper, resolution),
          hash_of(n.upper_right, resolution),
          n.has_right,
          n.has_upper};
}

TEST(KeptNeighbourhood, SharesTheVoxelsOfTheMap) {
  Map map({.resolution = 8, .bounds = {}});
  map.apply(0, {&kDisc, 1});
  const KeptNeighbourhood kept(map, {0, 0, 0});
  EXPECT_EQ(kept.view().own->crossings(Axis::x).data(),
            map.find({0, 0, 0})->crossings(Axis::x).data());
  EXPECT_EQ(kept.resolution(), 8);
}

TEST(KeptNeighbourhood, KnowsWhereTheMapEnds) {
  Map map({.resolution = 8, .bounds = ChunkRect{0, 0, 2, 1}});
  map.apply(0, {&kDisc, 1});
  const KeptNeighbourhood left(map, {0, 0, 0}), right(map, {0, 1, 0});
  EXPECT_TRUE(left.view().has_right);
  EXPECT_FALSE(left.view().has_upper);
  EXPECT_FALSE(right.view().has_right);
  EXPECT_TRUE(right.view().right->blank());
}

TEST(KeptNeighbourhood, OutlivesItsMap) {
  auto map = std::make_unique<Map>(Grid{.resolution = 8, .bounds = {}});
  map->apply(0, {&kDisc, 1});
  const KeptNeighbourhood kept(*map, {0, 1, 1});
  const std::uint64_t hash = map->find({0, 1, 1})->hash();
  map.reset();
  EXPECT_EQ(kept.view().own->hash(), hash);
}

/// Whatever becomes of the map, what was kept stays; and whoever keeps what, the map becomes what
/// it would have become.
TEST(KeptNeighbourhood, NeitherSideNoticesTheOther) {
  EXPECT_TRUE(rc::check([] {
    const Grid grid = *any_grid();
    Map map(grid), alone(grid);
    std::vector<std::pair<KeptNeighbourhood, std::vector<std::uint64_t>>> kept;
    for (const Stencil& stencil : *any_edits(2 * grid.resolution)) {
      map.apply(0, {&stencil, 1}), alone.apply(0, {&stencil, 1});
      const ChunkKey key{0, *rc::gen::inRange(-2, 2), *rc::gen::inRange(-2, 2)};
      kept.emplace_back(KeptNeighbourhood(map, key),
                        hashes(map.neighbourhood(key), grid.resolution));
      if (*rc::gen::inRange(0, 4) == 0) kept.erase(kept.begin());
      RC_ASSERT(map.hash() == alone.hash());
    }
    for (const auto& [chunks, then] : kept)
      RC_ASSERT(hashes(chunks.view(), grid.resolution) == then);
  }));
}

}  // namespace
}  // namespace earthwork::voxel
