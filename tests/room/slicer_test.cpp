// What is prepared bit by bit, and what has to wait for it.
#include "server/room/slicer.hpp"

#include <gtest/gtest.h>

#include "server/history/fold.hpp"
#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

const protocol::MapSettings kSettings{.chunk_resolution = 8, .chunks = {}};

Line::Waiting waiting(const protocol::Edit& edit, std::uint64_t author = 7) {
  return {.viewer = 1,
          .command = {.id = 1, .author = author, .action = edit},
          .cost = rows_visited(edit, kSettings)};
}

/// 1000 stamps of up to 7 x 7 chunks, from (0, 0) to (400, 0): some ten slices.
protocol::Edit large() {
  protocol::Edit edit = box(0, 0, 20);
  edit.is_path = true;
  for (int i = 1; i < 1000; ++i) edit.path.push_back({i * 0.4, 0});
  return edit;
}

int slices_until_through(Slicer& slicer) {
  int slices = 0;
  for (; !slicer.through(); ++slices) slicer.advance();
  return slices;
}

TEST(Slicer, CountsTheRowsThatAnEditLooksAt) {
  EXPECT_EQ(rows_visited(disc(0, 0, 0), kSettings), 32u);
  EXPECT_EQ(rows_visited(disc(0, 0, 20), kSettings), 392u);
  EXPECT_EQ(rows_visited(large(), kSettings), 392'000u);
}

TEST(Slicer, PreparesOnlyWhatCostsMoreThanTheBound) {
  Line::Waiting edit = waiting(disc(0, 0, 1));
  edit.cost = kMostRowsAtOnce;
  EXPECT_FALSE(Slicer::too_large(edit));
  edit.cost = kMostRowsAtOnce + 1;
  EXPECT_TRUE(Slicer::too_large(edit));
}

TEST(Slicer, GivesInTheEndWhatApplyGives) {
  voxel::Map map = history::make_map(kSettings), direct = history::make_map(kSettings);
  Slicer slicer(map);
  slicer.start(waiting(large()).command);
  const int slices = slices_until_through(slicer);
  EXPECT_GE(slices, 8);
  EXPECT_LE(slices, 13);
  EXPECT_EQ(map.hash(), 0u);
  EXPECT_EQ(slicer.commit(), history::apply(direct, large()));
  EXPECT_EQ(map.hash(), direct.hash());
  EXPECT_FALSE(slicer.busy());
}

TEST(Slicer, WhatComesNearOrIsLargeTooHasToWait) {
  voxel::Map map = history::make_map(kSettings);
  Slicer slicer(map);
  EXPECT_FALSE(slicer.must_wait(waiting(large())));
  slicer.start(waiting(large()).command);
  EXPECT_TRUE(slicer.must_wait(waiting(disc(50, 0, 1))));
  EXPECT_TRUE(slicer.must_wait(waiting(disc(-28, 0, 1))));
  EXPECT_FALSE(slicer.must_wait(waiting(disc(-60, 0, 1))));
  EXPECT_FALSE(slicer.must_wait(waiting(disc(50, 60, 1))));
  protocol::Edit far = large();
  for (auto& at : far.path) at.y = 1000;
  EXPECT_TRUE(slicer.must_wait(waiting(far)));
  slicer.clear();
  EXPECT_FALSE(slicer.must_wait(waiting(disc(50, 0, 1))));
  EXPECT_EQ(map.chunk_count(), 0u);
}

struct SlicedRoomTest : testing::Test, World {
  /// Now the large edit of this guest is in preparation, of which no slice is done.
  void begin(Guest& guest) {
    context.run();
    ASSERT_TRUE(submit(guest, large()));
    context.run(1);
  }
  void check_log() {
    voxel::Map again = history::make_map(room->settings());
    EXPECT_EQ(history::verify(again, events()), std::nullopt);
    EXPECT_EQ(again.hash(), room->info().hash);
  }
};

TEST_F(SlicedRoomTest, SmallEditsElsewhereAreAnsweredMeanwhile) {
  Guest a = enter(), b = enter();
  begin(a);
  context.run(2);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(submit(b, disc(500, 500 + i, 2)));
    context.run(2);
    EXPECT_EQ(b.eyes->acks.size(), static_cast<std::size_t>(i) + 1);
  }
  EXPECT_TRUE(a.eyes->acks.empty());
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 4}}));
  check_log();
}

TEST_F(SlicedRoomTest, TheHashShowsNothingOfWhatIsPrepared) {
  Guest a = enter(), b = enter();
  begin(a);
  ASSERT_TRUE(submit(b, disc(500, 500, 2)));
  context.run(3);
  EXPECT_EQ(room->info().seq, 1u);
  voxel::Map alone = history::make_map(room->settings());
  history::apply(alone, disc(500, 500, 2));
  EXPECT_EQ(room->info().hash, alone.hash());
  context.run();
  EXPECT_NE(room->info().hash, alone.hash());
}

TEST_F(SlicedRoomTest, OverlappingOnesComeAfterIt) {
  Guest a = enter(), b = enter(), c = enter();
  begin(a);
  ASSERT_TRUE(submit(b, disc(50, 0, 30, false)) && submit(b, disc(500, 500, 2)));
  ASSERT_TRUE(submit(c, disc(700, 500, 2)) && submit(c, disc(20, 0, 2, false)));
  context.run();
  EXPECT_EQ(c.eyes->acks.at(0), (protocol::Applied{1, 1}));
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 2}}));
  ASSERT_EQ(b.eyes->acks.size(), 2u);
  EXPECT_GT(b.eyes->acks[0].seq, 2u);
  EXPECT_GT(b.eyes->acks[1].seq, b.eyes->acks[0].seq);  // although it overlaps with nothing
  EXPECT_GT(c.eyes->acks.at(1).seq, 2u);
  check_log();
}

TEST_F(SlicedRoomTest, AnAuthorsOwnEditsComeAfterItInTheirOrder) {
  Guest a = enter(), b = enter();
  begin(a);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(submit(a, disc(500, 500, 1 + i)));
  ASSERT_TRUE(submit(b, disc(500, 600, 1)));
  context.run();
  EXPECT_EQ(b.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 2}, {2, 3}, {3, 4}, {4, 5}}));
  EXPECT_TRUE(a.eyes->refusals.empty());
}

TEST_F(SlicedRoomTest, LargeOnesOfManyAuthorsComeOneAfterAnother) {
  Guest a = enter(), b = enter();
  ASSERT_TRUE(submit(a, large()) && submit(a, large()) && submit(b, large()));
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {2, 3}}));
  EXPECT_EQ(b.eyes->acks, (std::vector<protocol::Applied>{{1, 2}}));
  check_log();
}

TEST_F(SlicedRoomTest, SentAgainMeanwhileItIsAppliedOnce) {
  Guest a = enter("ann", 77), again = enter("ann", 77);
  begin(a);
  context.run(2);
  ASSERT_TRUE(submit(again, large()));
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
  EXPECT_EQ(again.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
  EXPECT_EQ(meters->edits, 1u);
  EXPECT_EQ(meters->repeated, 1u);
}

TEST_F(SlicedRoomTest, WhoWaitsForItsNumberLeavesAfterIt) {
  Guest a = enter();
  begin(a);
  context.run(2);
  std::size_t told = 99;
  room->leave_when_told(a.id, [&] { told = a.eyes->acks.size(); });
  EXPECT_EQ(told, 99u);
  context.run();
  EXPECT_EQ(told, 1u);
  EXPECT_EQ(room->info().users, 0u);
}

TEST_F(SlicedRoomTest, WhoLeavesAtOnceLeavesItBehind) {
  Guest a = enter();
  begin(a);
  context.run(2);
  room->leave(a.id);
  context.run();
  EXPECT_TRUE(a.eyes->acks.empty());
  EXPECT_EQ(room->info().seq, 1u);
}

TEST_F(SlicedRoomTest, CountsAsWaiting) {
  Guest a = enter(), b = enter();
  begin(a);
  ASSERT_TRUE(submit(a, disc(500, 500, 2)) && submit(b, disc(50, 0, 2)));
  context.run(3);
  EXPECT_EQ(room->load().waiting_edits, 3u);
  context.run();
  EXPECT_EQ(room->load().waiting_edits, 0u);
}

TEST_F(SlicedRoomTest, ItsPointsCountAsWaiting) {
  Guest a = enter(), b = enter();
  begin(a);
  protocol::Edit longest = disc(0, 0, 0, false);
  longest.is_path = true;
  longest.path.assign(1024, {0, 0});
  for (std::size_t i = 1; i < 4096; ++i) ASSERT_TRUE(submit(b, longest)) << i;
  longest.path.resize(24);
  EXPECT_TRUE(submit(b, longest));
  EXPECT_FALSE(submit(b, disc(500, 500, 2)));
}

TEST_F(SlicedRoomTest, EndsWithItsMap) {
  Guest a = enter(), b = enter();
  begin(a);
  ASSERT_TRUE(submit(b, disc(50, 0, 2)));
  context.run(3);
  room->close({{protocol::Code::unknown_map, "the map was deleted", "map"}, {}});
  EXPECT_EQ(room->load().waiting_edits, 0u);
  context.run();
  EXPECT_TRUE(a.eyes->acks.empty());
  EXPECT_EQ(room->info().seq, 0u);
  EXPECT_EQ(room->info().hash, 0u);
}

}  // namespace
}  // namespace earthwork::room
