// Chunks as they were: a map becomes again exactly what it was.
#include "server/room/before_images.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <vector>

#include "server/history/fold.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

struct Changing {
  voxel::Map map = history::make_map({.chunk_resolution = 8, .chunks = {}});
  BeforeImages before{};

  void apply(const protocol::Edit& edit) {
    before.keep(map, static_cast<int>(edit.layer), history::stencils(edit));
    history::apply(map, edit);
  }
};

/// The chunks of a map, as their hashes.
std::vector<std::pair<voxel::ChunkKey, std::uint64_t>> chunks_of(const voxel::Map& map) {
  std::vector<std::pair<voxel::ChunkKey, std::uint64_t>> chunks;
  for (const voxel::ChunkKey& key : map.keys()) chunks.emplace_back(key, map.find(key)->hash());
  return chunks;
}

TEST(BeforeImages, GiveBackChunksThatWereRemoved) {
  Changing c;
  history::apply(c.map, box(8, 8, 7));
  const std::uint64_t hash = c.map.hash();
  c.apply(box(8, 8, 30, false));
  EXPECT_EQ(c.map.chunk_count(), 0u);
  c.before.take_back(c.map);
  EXPECT_EQ(c.map.chunk_count(), 4u);
  EXPECT_EQ(c.map.hash(), hash);
}

TEST(BeforeImages, TakeAwayChunksThatWereNotThere) {
  Changing c;
  c.apply(box(8, 8, 7));
  c.before.take_back(c.map);
  EXPECT_EQ(c.map.chunk_count(), 0u);
  EXPECT_EQ(c.map.hash(), 0u);
}

TEST(BeforeImages, WhatIsThroughIsNotTakenBack) {
  Changing c;
  c.apply(disc(4, 4, 2));
  c.before.hand_over();
  const auto after_first = chunks_of(c.map);
  c.apply(disc(6, 4, 2));
  c.before.forget_handed_over();
  c.before.take_back(c.map);
  EXPECT_EQ(chunks_of(c.map), after_first);
}

TEST(BeforeImages, WhatIsOnItsWayGoesBackToBeforeIt) {
  Changing c;
  c.apply(disc(4, 4, 2));
  c.before.hand_over();
  c.apply(disc(6, 4, 2));
  c.before.take_back(c.map);
  EXPECT_EQ(c.map.chunk_count(), 0u);
  c.apply(disc(4, 4, 2));  // and it begins anew
  c.before.hand_over();
  c.before.take_back(c.map);
  EXPECT_EQ(c.map.chunk_count(), 0u);
}

TEST(BeforeImages, KeepChunksByNameToo) {
  Changing c;
  history::apply(c.map, disc(4, 4, 2));
  const auto chunks = chunks_of(c.map);
  const voxel::ChunkKey keys[] = {{0, 0, 0, 0}, {0, 5, 5, 0}};
  c.before.keep(c.map, keys);
  history::apply(c.map, disc(5, 4, 2));
  c.map.put({0, 5, 5, 0}, *c.map.find({0, 0, 0, 0}));
  c.before.take_back(c.map);
  EXPECT_EQ(chunks_of(c.map), chunks);
}

TEST(BeforeImages, TheMapIsWhatItWasWhateverWasDone) {
  EXPECT_TRUE(rc::check([] {
    Changing c;
    const auto some_edit = [] {
      protocol::Edit edit = disc(*rc::gen::inRange(-99, 300) / 8.0, *rc::gen::inRange(0, 300) / 8.0,
                                 *rc::gen::inRange(0, 90) / 8.0, *rc::gen::arbitrary<bool>());
      edit.is_path = true;
      for (int i = *rc::gen::inRange(0, 4); i > 0; --i)
        edit.path.push_back({*rc::gen::inRange(0, 300) / 8.0, *rc::gen::inRange(0, 300) / 8.0});
      return edit;
    };
    auto durable = chunks_of(c.map), handed_over = durable;
    bool in_flight = false;
    for (int steps = *rc::gen::inRange(1, 40); steps > 0; --steps) {
      const int what = *rc::gen::inRange(0, 6);
      if (what == 0 && !in_flight) {
        c.before.hand_over();
        handed_over = chunks_of(c.map);
        in_flight = true;
      } else if (what == 1 && in_flight) {
        c.before.forget_handed_over();
        durable = handed_over;
        in_flight = false;
      } else if (what == 2) {
        c.before.take_back(c.map);
        RC_ASSERT(chunks_of(c.map) == durable);
        voxel::Map same = history::make_map({.chunk_resolution = 8, .chunks = {}});
        for (const voxel::ChunkKey& key : c.map.keys()) same.put(key, *c.map.find(key));
        RC_ASSERT(c.map.hash() == same.hash());
        in_flight = false;
      } else {
        c.apply(some_edit());
      }
    }
    c.before.take_back(c.map);
    RC_ASSERT(chunks_of(c.map) == durable);
  }));
}

}  // namespace
}  // namespace earthwork::room
