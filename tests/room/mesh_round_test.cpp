// A round of meshing: what it makes, whoever makes how much of it, while the map goes on.
#include "server/room/mesh_round.hpp"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "server/history/fold.hpp"
#include "server/room/manual_context.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

/// A map of 12 x 12 chunks of 8 voxels with something in every one, and nothing meshed.
struct MeshRoundTest : testing::Test {
  MeshRoundTest() {
    for (int x = 0; x < 12; ++x)
      for (int y = 0; y < 12; ++y) edit(disc(8 * x + 4, 8 * y + 4, 2 + 0.1 * x + 0.1 * y));
  }
  void edit(const protocol::Edit& edit) {
    for (const auto& dirty : history::apply(map, edit).dirty) stale.insert(dirty.key);
  }
  std::shared_ptr<MeshRound> take_all() {
    const std::vector<voxel::ChunkKey> keys(stale.begin(), stale.end());
    stale.clear();
    cache.mark_stale(keys);
    return std::make_shared<MeshRound>(map, cache, keys, ++seq);
  }
  static MeshRound::Makers makers(int count) {
    MeshRound::Makers makers;
    while (count-- > 0) makers.push_back(std::make_unique<MeshMaker>(135));
    return makers;
  }
  /// Tasks of both kinds run in one line.
  Workplace by_hand() {
    const auto post = [this](Strand::Task task) { strand->post(std::move(task)); };
    return {post, post};
  }
  /// What the mesh hash of the map would be if all were meshed now.
  std::uint64_t true_hash() const {
    MeshCache fresh;
    MeshMaker maker(135);
    for (const voxel::ChunkKey& key : map.meshed_keys())
      fresh.put(key, maker.make(key, map.neighbourhood(key), 8, fresh.forerunner(key, 1)));
    return fresh.totals().hash;
  }

  voxel::Map map = history::make_map({.chunk_resolution = 8, .chunks = {}});
  std::set<voxel::ChunkKey> stale;
  MeshCache cache;
  std::uint64_t seq = 0;
  ManualContext context;
  std::unique_ptr<Strand> strand = context.make_strand();
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
};

TEST_F(MeshRoundTest, MakesEverythingAndSaysSoOnce) {
  const std::uint64_t want = true_hash();
  const auto round = take_all();
  int done = 0;
  round->start(by_hand(), makers(3), meters, [&] { ++done; });
  context.run();
  EXPECT_EQ(done, 1);
  EXPECT_EQ(round->finish(cache).size(), 3u);
  EXPECT_EQ(cache.stale_count(), 0u);
  EXPECT_EQ(cache.totals().hash, want);
  EXPECT_EQ(cache.find({0, 5, 5})->revision, 1u);
  EXPECT_GE(meters->meshed_chunks, 144u);
  EXPECT_GT(meters->mesh_ns, 0u);
}

TEST_F(MeshRoundTest, ShowsTheMapAsItWas) {
  const std::uint64_t want = true_hash();
  const auto round = take_all();
  round->start(by_hand(), makers(2), meters, [] {});
  context.run(3);
  edit(box(48, 48, 40, false));  // most of the map is gone
  context.run();
  (void)round->finish(cache);
  EXPECT_EQ(cache.totals().hash, want);
}

TEST_F(MeshRoundTest, LeavesAnUnchangedMeshItsRevision) {
  const auto first = take_all();
  first->start(by_hand(), makers(1), meters, [] {});
  context.run();
  (void)first->finish(cache);
  edit(box(20.5, 20.5, 0.5, false));
  edit(disc(20, 20, 2.4));
  edit(disc(40, 40, 3.9));
  const auto second = take_all();
  second->start(by_hand(), makers(1), meters, [] {});
  context.run();
  (void)second->finish(cache);
  EXPECT_EQ(cache.find({0, 1, 1})->revision, 1u);
  EXPECT_EQ(cache.find({0, 4, 4})->revision, 2u);
  EXPECT_EQ(cache.totals().hash, true_hash());
}

TEST_F(MeshRoundTest, AMeshFromBeforeAStartKeepsItsAge) {
  std::vector<journal::ChunkAge> ages;
  for (const voxel::ChunkKey& key : map.keys()) ages.push_back({key, 7});
  cache.restore(map, ages);
  seq = 20;
  const std::vector<voxel::ChunkKey> keys{{0, 3, 3}, {0, 4, 4}};
  cache.mark_stale(std::span(keys).last(1));
  const auto round = std::make_shared<MeshRound>(map, cache, keys, seq);
  round->start(by_hand(), makers(1), meters, [] {});
  context.run();
  (void)round->finish(cache);
  EXPECT_EQ(cache.find({0, 3, 3})->revision, 7u);
  EXPECT_EQ(cache.find({0, 4, 4})->revision, 20u);
}

TEST_F(MeshRoundTest, CanBeHelpedToItsEnd) {
  const auto round = take_all();
  int done = 0;
  round->start(by_hand(), makers(2), meters, [&] { ++done; });
  context.run(2);
  MeshMaker own(135);
  std::size_t budget = 10;
  EXPECT_FALSE(round->help(own, budget));
  EXPECT_EQ(budget, 0u);
  EXPECT_FALSE(round->help(own, budget));
  budget = 1000;
  EXPECT_TRUE(round->help(own, budget));
  EXPECT_GT(budget, 0u);
  EXPECT_EQ(round->finish(cache).size(), 2u);
  EXPECT_EQ(cache.totals().hash, true_hash());
  context.run();  // slices that waited find nothing to do
  EXPECT_EQ(done, 0);
}

TEST_F(MeshRoundTest, EndsWithItsRoom) {
  const auto watched = std::make_shared<int>(7);
  std::weak_ptr<MeshRound> weak;
  {
    const auto round = take_all();
    weak = round;
    bool room = true;
    const auto aside = [&](Strand::Task task) {
      if (room) strand->post(std::move(task));
    };
    round->start({aside, aside}, makers(2), meters, [watched] { FAIL() << "nobody to tell"; });
    context.run(2);
    room = false;
    context.run();
  }
  EXPECT_TRUE(weak.expired());
  EXPECT_EQ(watched.use_count(), 1);
}

TEST_F(MeshRoundTest, ThrowsWhatASliceThrew) {
  // No record is as short as this one.
  cache.put({0, 5, 5}, CachedMesh{.bytes = std::make_shared<const std::string>("short")});
  const auto round = take_all();
  int done = 0;
  round->start(by_hand(), makers(2), meters, [&] { ++done; });
  context.run();
  EXPECT_EQ(done, 1);
  EXPECT_THROW((void)round->finish(cache), std::out_of_range);
  EXPECT_EQ(cache.stale_count(), 144u);  // nothing was put
}

/// On threads: the map is edited, hashed and dropped while slices read what they were given.
TEST_F(MeshRoundTest, RunsBesideTheEditsOfItsMap) {
  boost::asio::thread_pool pool(3);
  const auto serial = boost::asio::make_strand(pool);
  const Workplace place{[&](Strand::Task task) { boost::asio::post(pool, std::move(task)); },
                        [&](Strand::Task task) { boost::asio::post(serial, std::move(task)); }};
  for (int n = 0; n < 20; ++n) {
    const std::uint64_t want = true_hash();
    for (const voxel::ChunkKey& key : map.meshed_keys()) stale.insert(key);
    auto round = take_all();
    const auto done = std::make_shared<std::promise<void>>();
    round->start(place, makers(3), meters, [done] { done->set_value(); });
    for (int k = 0; k < 40; ++k) edit(disc(2.3 * k, 96 - 2.1 * k, 1 + k % 5, (n + k) % 2 != 0));
    std::size_t budget = 8;
    MeshMaker own(135);
    if (n % 2 == 0 || !round->help(own, budget)) done->get_future().wait();
    (void)round->finish(cache);
    ASSERT_EQ(cache.totals().hash, want) << n;
  }
  pool.join();
}

}  // namespace
}  // namespace earthwork::room
