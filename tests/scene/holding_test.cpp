// What a viewer may claim: never more than it holds, and all that it holds where that is a
// rectangle.
#include "client/scene/holding.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <set>

#include "protocol/json_text.hpp"

namespace earthwork::scene {
namespace {

using protocol::ChunkKey;
using protocol::ChunkRange;
using protocol::MapRect;
using protocol::MapSettings;

constexpr std::uint64_t kEpoch = 0xaa;

MapSettings bounded(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
  MapSettings settings;
  settings.chunks = {x0, y0, x1, y1};
  return settings;
}

ChunkRange claimed(const Holding& holding, const MapSettings& settings) {
  const auto have = holding.have();
  return have ? protocol::chunks_of_cells(have->rect, settings) : ChunkRange{};
}

TEST(Holding, ClaimsNothingBeforeAViewIsComplete) {
  Holding holding;
  holding.join(kEpoch, 7);
  EXPECT_EQ(holding.have(), std::nullopt);
  holding.look(1, {}, {});
  holding.reach(8);
  EXPECT_EQ(holding.have(), std::nullopt);
  holding.catch_up(2, 9);
  EXPECT_EQ(holding.have(), std::nullopt) << "of another view";
  holding.catch_up(1, 9);
  ASSERT_TRUE(holding.have());
  EXPECT_EQ(holding.have()->epoch, "00000000000000aa");
  EXPECT_EQ(holding.have()->seq, 9u);
}

TEST(Holding, ClaimsTheLastGroupThatEnded) {
  Holding holding;
  holding.join(kEpoch, 3);
  holding.look(1, {}, {});
  holding.catch_up(1, 3);
  holding.reach(6);
  EXPECT_EQ(holding.have()->seq, 6u);
}

TEST(Holding, ClaimsTheOldSeqUntilItHasCaughtUpAgain) {
  Holding holding;
  holding.join(kEpoch, 3);
  holding.look(1, {}, {});
  holding.catch_up(1, 3);
  holding.join(kEpoch, 10);
  holding.look(1, {}, {});
  holding.reach(11);  // of what was sent again; the rest may still be as of 3
  EXPECT_EQ(holding.have()->seq, 3u);
  holding.catch_up(1, 11);
  EXPECT_EQ(holding.have()->seq, 11u);
}

TEST(Holding, ClaimsOfAMovedViewWhatBothShow) {
  const MapSettings settings = bounded(0, 0, 10, 10);
  Holding holding;
  holding.join(kEpoch, 3);
  holding.look(1, MapRect{10, 10, 100, 100}, settings);  // chunks 0 .. 3
  holding.catch_up(1, 3);
  EXPECT_EQ(claimed(holding, settings), (ChunkRange{0, 0, 4, 4}));
  holding.look(2, MapRect{70, 10, 200, 60}, settings);  // chunks 2 .. 6, 0 .. 1
  EXPECT_EQ(claimed(holding, settings), (ChunkRange{2, 0, 4, 2}));
  EXPECT_TRUE(holding.wants({0, 6, 1, 0}));
  EXPECT_FALSE(holding.wants({0, 1, 1, 0}));
  holding.reach(4);  // groups keep what was sent up to date while the new ones arrive
  EXPECT_EQ(holding.have()->seq, 4u);
  holding.look(3, MapRect{300, 300, 310, 310}, settings);
  EXPECT_EQ(holding.have(), std::nullopt);
}

TEST(Holding, IsVoidInAnotherEpochAndInAMapThatIsBehind) {
  for (const bool behind : {false, true}) {
    Holding holding;
    holding.join(kEpoch, 5);
    holding.look(1, {}, {});
    holding.catch_up(1, 5);
    holding.join(behind ? kEpoch : kEpoch + 1, behind ? 4 : 5);
    EXPECT_EQ(holding.have(), std::nullopt);
    EXPECT_EQ(holding.seq(), 0u);
  }
}

TEST(Holding, ClaimsNothingOfAMapWithoutEvents) {
  Holding holding;
  holding.join(kEpoch, 0);
  holding.look(1, {}, {});
  holding.catch_up(1, 0);
  EXPECT_EQ(holding.have(), std::nullopt);
}

RC_GTEST_PROP(Holding, NamesAllChunksOfAMapAndNoOthers, ()) {
  MapSettings settings;
  settings.chunk_resolution = *rc::gen::element(8, 16, 32, 64);
  settings.voxel_size = *rc::gen::element(1e-6, 0.1, 1.0, 3.7, 1e6);
  if (*rc::gen::arbitrary<bool>()) {
    const auto end = protocol::kWorldVoxels / settings.chunk_resolution;
    const auto low = *rc::gen::inRange(-end, end);
    const auto high = *rc::gen::inRange(low + 1, end + 1);
    settings.chunks = {low, low, high, high};
  }
  Holding holding;
  holding.join(kEpoch, 5);
  holding.look(1, {}, settings);
  holding.catch_up(1, 5);
  RC_ASSERT(claimed(holding, settings) == protocol::map_extent(settings));
}

// A server that keeps what each chunk shows for a viewer: a claim must never name a chunk that the
// viewer shows as of an earlier edit than it claims.
RC_GTEST_PROP(Holding, NeverClaimsAChunkThatIsOlder, ()) {
  constexpr std::int32_t kSide = 4;
  const MapSettings settings = bounded(0, 0, kSide, 1);
  std::map<std::int32_t, std::uint64_t> changed, shown;  // by x: the last edit
  std::set<std::int32_t> sent;                           // over this connection, or claimed
  std::uint64_t seq = 1;
  std::uint32_t view = 0;
  Holding holding;
  const auto look = [&](std::optional<MapRect> rect) { holding.look(++view, rect, settings); };
  holding.join(kEpoch, seq);
  look({});
  for (int steps = *rc::gen::inRange(0, 40); steps > 0; --steps) {
    const int step = *rc::gen::inRange(0, 6);
    const auto x = *rc::gen::inRange<std::int32_t>(0, kSide);
    if (step == 0) changed[x] = ++seq;
    if (step == 1) {  // a group: what was sent before and is wanted
      for (const std::int32_t seen : sent) shown[seen] = seq;
      holding.reach(seq);
    }
    if (step == 2 && holding.wants({0, x, 0, 0})) {  // one of a first load
      shown[x] = seq;
      sent.insert(x);
    }
    if (step == 3) {  // the rest of it
      for (std::int32_t i = 0; i < kSide; ++i)
        if (holding.wants({0, i, 0, 0})) shown[i] = seq, sent.insert(i);
      holding.catch_up(view, seq);
    }
    if (step == 4) look(MapRect{x * 32.0 + 1, 1, x * 32.0 + 40, 2});
    if (step == 5) {
      holding.join(kEpoch, seq);
      sent.clear();
    }
    std::erase_if(sent, [&](std::int32_t i) { return !holding.wants({0, i, 0, 0}); });
    std::erase_if(shown, [&](const auto& s) { return !holding.wants({0, s.first, 0, 0}); });
    const ChunkRange claim = claimed(holding, settings);
    for (std::int32_t i = 0; i < kSide; ++i) {
      if (!claim.contains(i, 0)) continue;
      RC_ASSERT(shown.contains(i));
      const bool newer = changed[i] > shown[i];
      RC_ASSERT(!newer || changed[i] > holding.have()->seq);
    }
  }
}

}  // namespace
}  // namespace earthwork::scene
