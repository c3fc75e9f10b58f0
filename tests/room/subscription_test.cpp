// What a viewer is sent of which part of the map: views that move, loads that are disturbed,
// claims of what somebody has already.
#include "server/room/subscription.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using protocol::ChunkKey;

std::vector<ChunkKey> keys(const std::vector<RecordBytes>& records) {
  std::vector<ChunkKey> keys;
  for (const RecordBytes& bytes : records) keys.push_back(key_of(bytes));
  return keys;
}

/// A disc in the middle of each of 12 x 12 chunks of 8 voxels.
struct SubscriptionTest : testing::Test, World {
  SubscriptionTest() : painter(enter("painter")) {
    for (int x = 0; x < 12; ++x)
      for (int y = 0; y < 12; ++y) edit(painter, dot(x, y));
    seq = room->info().seq;
  }
  static protocol::Edit dot(int x, int y, bool fill = true) {
    return disc(8 * x + 4.5, 8 * y + 4.5, 2, fill);
  }
  protocol::View claim(std::uint32_t n, std::uint64_t since, const char* epoch) {
    protocol::View view = view_rect(n, {1, 1, 95, 95});
    view.have = protocol::Have{.epoch = epoch, .seq = since, .rect = {1, 1, 95, 95}};
    return view;
  }
  Guest painter;
  std::uint64_t seq = 0;
};

TEST_F(SubscriptionTest, ShowsOnlyChunksThatTouchTheView) {
  Guest a = enter();
  look(a, view_rect(1, {17, 25, 30, 31}));  // chunks 2 .. 3 across, 3 up
  std::set<ChunkKey> seen;
  for (const auto& [key, record] : a.eyes->chunks) seen.insert(key);
  EXPECT_EQ(seen, (std::set<ChunkKey>{{0, 2, 3, 0}, {0, 3, 3, 0}}));

  a.eyes->forget_parcels();
  edit(painter, dot(7, 7, false));
  edit(painter, dot(3, 3, false));
  ASSERT_EQ(a.eyes->parcels.size(), 1u);
  EXPECT_EQ(keys(a.eyes->parcels[0].group_records), (std::vector<ChunkKey>{{0, 3, 3, 0}}));
}

TEST_F(SubscriptionTest, AViewReachesTheMeshOfTheChunkToItsLeft) {
  // The mesh of chunk 1 ends half a voxel inside chunk 2.
  Guest a = enter();
  look(a, view_rect(1, {16.25, 17, 20, 20}));
  EXPECT_TRUE(a.eyes->chunks.contains({0, 1, 2, 0}));
  Guest b = enter();
  look(b, view_rect(1, {16.75, 17, 20, 20}));
  EXPECT_FALSE(b.eyes->chunks.contains({0, 1, 2, 0}));
}

TEST_F(SubscriptionTest, LoadsTheMiddleFirst) {
  Guest a = enter();
  look(a, view_rect(1, {1, 1, 95, 95}));
  std::vector<ChunkKey> order;
  for (const Parcel& parcel : a.eyes->parcels)
    for (const ChunkKey& key : keys(parcel.first_seen)) order.push_back(key);
  ASSERT_EQ(order.size(), 144u);
  const auto distance = [](const ChunkKey& key) {
    return std::abs(2 * key.x - 11) * std::abs(2 * key.x - 11) +
           std::abs(2 * key.y - 11) * std::abs(2 * key.y - 11);
  };
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_LE(distance(order[i - 1]), distance(order[i])) << i;
}

TEST_F(SubscriptionTest, ALoadComesInPartsAndIsCaughtUpOnce) {
  Guest a = enter();
  look(a, view_all(9));
  EXPECT_GE(a.eyes->parcels.size(), 3u);  // 64 chunks are meshed for one
  int said = 0;
  for (const Parcel& parcel : a.eyes->parcels) said += parcel.caught_up.has_value();
  EXPECT_EQ(said, 1);
  EXPECT_EQ(*a.eyes->parcels.back().caught_up, (protocol::CaughtUp{9, seq}));
}

TEST_F(SubscriptionTest, EditsDuringALoadComeAsGroupsAndDoNotStartItAgain) {
  Guest a = enter();
  ASSERT_TRUE(room->look(a.id, view_rect(1, {1, 1, 95, 95})));
  context.run();
  ASSERT_EQ(a.eyes->parcels.size(), 1u);  // of three
  edit(painter, dot(5, 5, false));        // was sent first of all
  edit(painter, dot(0, 0, false));        // was not sent yet,
  edit(painter, disc(93, 93, 2.5));       // nor was this one
  room->ready(a.id);
  context.run();
  ASSERT_EQ(a.eyes->parcels.size(), 2u);
  const Parcel second = a.eyes->parcels[1];
  EXPECT_EQ(keys(second.group_records), (std::vector<ChunkKey>{{0, 5, 5, 0}}));
  EXPECT_EQ(second.first_seen.size(), 64u);
  EXPECT_FALSE(second.caught_up);
  settle(a);
  EXPECT_EQ(a.eyes->grouped(), 1u);
  EXPECT_EQ(a.eyes->first_seen(), 144u - 1u);
  EXPECT_EQ(*a.eyes->parcels.back().caught_up, (protocol::CaughtUp{1, seq + 3}));
  EXPECT_EQ(a.eyes->mesh_hash(), mesh_hash());
}

TEST_F(SubscriptionTest, AMovedViewBringsTheNewChunksOnly) {
  Guest a = enter();
  look(a, view_rect(1, {1, 1, 30, 30}));  // chunks 0 .. 3
  a.eyes->forget_parcels();
  look(a, view_rect(2, {9, 1, 38, 30}));  // 1 .. 4
  EXPECT_EQ(a.eyes->first_seen(), 4u);
  EXPECT_EQ(*a.eyes->parcels.back().caught_up, (protocol::CaughtUp{2, seq}));
}

TEST_F(SubscriptionTest, AMovedViewForgetsTheOld) {
  Guest a = enter();
  look(a, view_rect(1, {1, 1, 30, 30}));
  look(a, view_rect(2, {65, 65, 90, 90}));
  a.eyes->forget_parcels();
  edit(painter, dot(1, 1, false));
  EXPECT_EQ(a.eyes->grouped(), 0u);
  look(a, view_rect(3, {1, 1, 30, 30}));
  EXPECT_EQ(a.eyes->first_seen(), 15u);  // all but the one that is empty now
}

TEST_F(SubscriptionTest, OwedChunksSurviveAMoveOfTheView) {
  Guest a = enter();
  look(a, view_rect(1, {1, 1, 30, 30}));
  context.advance(std::chrono::seconds(1)), settle(a);
  edit(painter, dot(2, 2, false));  // takes the parcel
  edit(painter, dot(3, 3, false));  // is owed,
  edit(painter, disc(5, 5, 3));     // and this, until the view leaves it
  ASSERT_TRUE(room->look(a.id, view_rect(2, {9, 9, 38, 38})));
  settle(a);
  EXPECT_FALSE(a.eyes->chunks.contains({0, 3, 3, 0}));
  EXPECT_EQ(keys(a.eyes->parcels.back().group_records), (std::vector<ChunkKey>{{0, 3, 3, 0}}));
}

TEST_F(SubscriptionTest, ChunksThatAppearInAViewComeInGroups) {
  Guest a = enter();
  look(a, view_rect(1, {-60, -60, -10, -10}));
  EXPECT_TRUE(a.eyes->chunks.empty());
  a.eyes->forget_parcels();
  edit(painter, dot(-4, -4));
  EXPECT_EQ(a.eyes->grouped(), 1u);
  EXPECT_EQ(a.eyes->first_seen(), 0u);
}

TEST_F(SubscriptionTest, WhoClaimsToHaveAllIsSentNothing) {
  Guest a = enter();
  look(a, view_all(1));  // now the meshes have their revisions
  Guest b = enter();
  look(b, claim(1, seq, "000000000000abcd"));
  EXPECT_EQ(b.eyes->first_seen(), 0u);
  EXPECT_EQ(*b.eyes->parcels.back().caught_up, (protocol::CaughtUp{1, seq}));
}

TEST_F(SubscriptionTest, WhoWasAwayIsSentWhatIsNewAndWhatIsGone) {
  Guest a = enter();
  look(a, view_all(1));
  edit(painter, dot(2, 2, false));
  edit(painter, disc(8 * 3 + 4.5, 8 * 3 + 4.5, 3));
  settle(a);

  Guest b = enter();
  look(b, claim(1, seq, "000000000000abcd"));
  std::vector<protocol::ChunkRecord> records;
  for (const Parcel& parcel : b.eyes->parcels)
    for (const RecordBytes& bytes : parcel.first_seen) records.push_back(decoded(bytes));
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].key, (ChunkKey{0, 3, 3, 0}));  // nearer to the middle
  EXPECT_FALSE(records[0].removed);
  EXPECT_EQ(records[1].key, (ChunkKey{0, 2, 2, 0}));
  EXPECT_TRUE(records[1].removed);
}

TEST_F(SubscriptionTest, WhatAViewerWasSentChangesByDeltas) {
  Guest a = enter();
  look(a, view_rect(1, {1, 1, 30, 30}));
  a.eyes->forget_parcels();
  edit(painter, disc(8 * 2 + 5.5, 8 * 2 + 4.5, 2));
  ASSERT_EQ(a.eyes->parcels.size(), 1u);
  const RecordBytes& sent = a.eyes->parcels[0].group_records.at(0);
  EXPECT_TRUE(is_delta(sent));
  EXPECT_EQ(key_of(sent), (ChunkKey{0, 2, 2, 0}));
  Guest b = enter();
  look(b, view_rect(1, {1, 1, 30, 30}));
  EXPECT_EQ(a.eyes->mesh_hash(), b.eyes->mesh_hash());
}

TEST_F(SubscriptionTest, WhoMissedARevisionIsSentAllOfTheNext) {
  Guest a = enter(), b = enter();
  look(a, view_rect(1, {1, 1, 30, 30})), look(b, view_rect(1, {1, 1, 30, 30}));
  edit(painter, disc(8 * 3 + 4.5, 8 * 3 + 4.5, 2.5));  // takes both parcels
  room->ready(b.id);
  edit(painter, disc(8 * 2 + 5.5, 8 * 2 + 4.5, 2));  // is shown to b alone
  room->ready(b.id);
  edit(painter, disc(8 * 2 + 4.5, 8 * 2 + 5.5, 2));
  EXPECT_TRUE(is_delta(b.eyes->parcels.back().group_records.at(0)));
  room->ready(a.id);
  EXPECT_FALSE(is_delta(a.eyes->parcels.back().group_records.at(0)));
  EXPECT_EQ(a.eyes->mesh_hash(), b.eyes->mesh_hash());
}

TEST_F(SubscriptionTest, NoDeltaStartsFromWhatWasOnlyClaimed) {
  Guest a = enter();
  look(a, view_all(1));
  Guest b = enter();
  look(b, claim(1, seq, "000000000000abcd"));
  b.eyes->chunks = a.eyes->chunks;  // what it had before
  edit(painter, disc(8 * 2 + 5.5, 8 * 2 + 4.5, 2));
  EXPECT_FALSE(is_delta(b.eyes->parcels.back().group_records.at(0)));
  room->ready(b.id);
  edit(painter, disc(8 * 2 + 4.5, 8 * 2 + 5.5, 2));
  EXPECT_TRUE(is_delta(b.eyes->parcels.back().group_records.at(0)));
  settle(a);
  EXPECT_EQ(b.eyes->mesh_hash(), a.eyes->mesh_hash());
}

TEST_F(SubscriptionTest, AClaimFromAnotherEpochCountsForNothing) {
  Guest b = enter();
  look(b, claim(1, seq, "000000000000abce"));
  EXPECT_EQ(b.eyes->first_seen(), 144u);
}

TEST_F(SubscriptionTest, AClaimFromTheFutureCountsForNothing) {
  Guest b = enter();
  look(b, claim(1, seq + 1, "000000000000abcd"));
  EXPECT_EQ(b.eyes->first_seen(), 144u);
}

TEST_F(SubscriptionTest, AClaimCountsInsideItsRectangleOnly) {
  Guest a = enter();
  look(a, view_all(1));
  Guest b = enter();
  protocol::View view = claim(1, seq, "000000000000abcd");
  view.have->rect = {1, 1, 7, 95};  // the left column
  look(b, view);
  EXPECT_EQ(b.eyes->first_seen(), 132u);
}

TEST_F(SubscriptionTest, AClaimIsStillTrueWhenTheViewMoves) {
  Guest before = enter();
  look(before, view_rect(1, {1, 1, 95, 95}));
  edit(painter, dot(1, 1, false));
  edit(painter, dot(11, 11, false));
  Guest again = enter();
  again.eyes->chunks = before.eyes->chunks;  // but for what a group has removed
  for (const auto& [key, record] : before.eyes->chunks) again.eyes->chunks[key] = record;
  const auto place = [](int x, int y) { return ChunkKey{0, x, y, 0}; };
  again.eyes->chunks[place(1, 1)].key = place(1, 1);
  again.eyes->chunks[place(11, 11)].key = place(11, 11);
  ASSERT_TRUE(room->look(again.id, claim(1, seq, "000000000000abcd")));
  context.run(1);  // it is taken up, and not through yet
  look(again, view_rect(2, {1, 1, 80, 80}));
  EXPECT_FALSE(again.eyes->chunks.contains(place(1, 1)));
  EXPECT_LE(again.eyes->first_seen(), 3u);  // what is held does not come again
}

TEST_F(SubscriptionTest, AViewThatOvertakesAnotherKeepsItsClaim) {
  Guest before = enter();
  look(before, view_rect(1, {1, 1, 95, 95}));
  edit(painter, dot(1, 1, false));
  Guest again = enter();
  again.eyes->chunks[ChunkKey{0, 1, 1, 0}].key = {0, 1, 1, 0};
  ASSERT_TRUE(room->look(again.id, claim(1, seq, "000000000000abcd")));
  ASSERT_TRUE(room->look(again.id, view_rect(2, {1, 1, 80, 80})));
  settle(again);
  ASSERT_TRUE(again.eyes->parcels.back().caught_up);
  EXPECT_EQ(again.eyes->parcels.back().caught_up->n, 2u);
  EXPECT_FALSE(again.eyes->chunks.contains(ChunkKey{0, 1, 1, 0}));
  EXPECT_LE(again.eyes->first_seen(), 2u);
}

TEST_F(SubscriptionTest, AFloodOfViewsIsOneView) {
  Guest a = enter();
  for (std::uint32_t n = 1; n <= 64; ++n)
    ASSERT_TRUE(room->look(a.id, view_rect(n, {1, 1, 8.0 + n, 95})));
  EXPECT_LE(context.run(), 20);
  settle(a);
  ASSERT_TRUE(a.eyes->parcels.back().caught_up);
  EXPECT_EQ(a.eyes->parcels.back().caught_up->n, 64u);
}

TEST(ThenLooks, KeepsOfAnEarlierClaimWhatBothViewsHold) {
  using protocol::Have, protocol::MapRect, protocol::View;
  const Have have{.epoch = "fedcba9876543210", .seq = 7, .rect = {0, 0, 10, 10}};
  const View first{.n = 1, .rect = MapRect{5, -5, 20, 20}, .have = have, .id = 1};
  View second{.n = 2, .rect = MapRect{0, 0, 8, 8}, .have = {}, .id = 2};
  ASSERT_TRUE(then_looks(first, second).have);
  EXPECT_EQ(then_looks(first, second).have->rect, (MapRect{5, 0, 10, 10}));
  EXPECT_EQ(then_looks(first, second).n, 2u);
  const View elsewhere{.n = 1, .rect = MapRect{11, 0, 20, 20}, .have = have, .id = {}};
  EXPECT_FALSE(then_looks(elsewhere, second).have);
  const View everything{.n = 1, .rect = {}, .have = have, .id = {}};
  EXPECT_EQ(then_looks(everything, second).have, have);
  second.have = Have{.epoch = "0000000000000000", .seq = 1, .rect = {0, 0, 1, 1}};
  EXPECT_EQ(then_looks(first, second), second);
}

}  // namespace
}  // namespace earthwork::room
