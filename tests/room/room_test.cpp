// A room: one order, groups, views, and what a slow viewer is owed.
#include "server/room/room.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <stdexcept>

#include "server/history/fold.hpp"
#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

struct RoomTest : testing::Test, World {};

TEST_F(RoomTest, NumbersEditsInTheOrderTheyCome) {
  Guest a = enter(), b = enter();
  ASSERT_TRUE(submit(a, disc(4, 4, 2)) && submit(b, disc(9, 4, 2)) && submit(a, disc(4, 9, 2)));
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {2, 3}}));
  EXPECT_EQ(b.eyes->acks, (std::vector<protocol::Applied>{{1, 2}}));
}

TEST_F(RoomTest, AnEditThatChangesNothingTakesANumberToo) {
  Guest a = enter();
  edit(a, disc(4, 4, 2));
  edit(a, disc(4, 4, 2));
  edit(a, disc(4, 4, 2, false));
  EXPECT_EQ(a.eyes->acks.back(), (protocol::Applied{3, 3}));
  EXPECT_EQ(room->info().seq, 3u);
}

TEST_F(RoomTest, ARefusedEditTakesNone) {
  Guest a = enter();
  const auto refused = submit(a, disc(4, 4, 513));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "radius");
  context.run();
  EXPECT_TRUE(a.eyes->acks.empty());
  EXPECT_EQ(room->info().seq, 0u);
}

TEST_F(RoomTest, KeepsWhatItAccepted) {
  Guest a = enter();
  context.advance(5s);
  edit(a, disc(4, 4, 2));
  edit(a, box(20, 4, 3));
  const auto kept = events();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[1].seq, 2u);
  EXPECT_EQ(kept[1].time_ms, 5000);
  EXPECT_EQ(kept[1].author, 7u);
  EXPECT_EQ(kept[1].id, 2);
  EXPECT_EQ(kept[1].action, protocol::Action(box(20, 4, 3)));
  EXPECT_EQ(kept[1].hash, room->info().hash);

  voxel::Map again = history::make_map(room->settings());
  EXPECT_EQ(history::verify(again, kept), std::nullopt);
}

TEST_F(RoomTest, TellsWhoIsThere) {
  Guest a = enter("ann");
  auto bob = std::make_shared<Onlooker>();
  const auto entrance =
      room->join(bob, {"00000000000000bb", "bob", "#000000", "00000000000000b0"}).value();
  EXPECT_EQ(entrance.joined.map, "m");
  EXPECT_EQ(entrance.joined.epoch, "000000000000abcd");
  EXPECT_EQ(entrance.joined.seq, 0u);
  ASSERT_EQ(entrance.joined.users.size(), 2u);
  EXPECT_EQ(entrance.joined.users[0].name, "ann");
  EXPECT_EQ(entrance.joined.users[1].name, "bob");
  room->leave(a.id);
  EXPECT_EQ(room->info().users, 1u);
}

TEST_F(RoomTest, ShowsNothingWithoutAView) {
  Guest a = enter();
  edit(a, disc(4, 4, 2));
  context.advance(1s);
  EXPECT_TRUE(a.eyes->parcels.empty());
}

TEST_F(RoomTest, AFirstLoadComesOutsideGroupsAndThenCaughtUp) {
  Guest a = enter();
  edit(a, box(8, 8, 7));
  look(a, view_all(3));
  EXPECT_EQ(a.eyes->grouped(), 0u);
  EXPECT_EQ(a.eyes->first_seen(), 4u);
  ASSERT_TRUE(a.eyes->parcels.back().caught_up);
  EXPECT_EQ(*a.eyes->parcels.back().caught_up, (protocol::CaughtUp{3, 1}));
  EXPECT_EQ(a.eyes->mesh_hash(), mesh_hash());
}

TEST_F(RoomTest, AnEmptyMapIsCaughtUpAtOnce) {
  Guest a = enter();
  look(a, view_all(1));
  ASSERT_EQ(a.eyes->parcels.size(), 1u);
  EXPECT_EQ(*a.eyes->parcels[0].caught_up, (protocol::CaughtUp{1, 0}));
}

TEST_F(RoomTest, AnEditComesAsOneGroup) {
  Guest a = enter(), b = enter();
  look(b, view_all(5));
  b.eyes->forget_parcels();
  edit(a, box(8, 8, 7));
  ASSERT_EQ(b.eyes->parcels.size(), 1u);
  EXPECT_EQ(*b.eyes->parcels[0].group, (protocol::GroupBegin{0xABCD, 1, 5}));
  EXPECT_EQ(b.eyes->parcels[0].group_records.size(), 4u);
  EXPECT_EQ(b.eyes->mesh_hash(), mesh_hash());
}

TEST_F(RoomTest, EditsThatWaitTogetherAreShownOnce) {
  Guest a = enter();
  look(a, view_all(1));
  a.eyes->forget_parcels();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(submit(a, disc(4 + 0.25 * i, 4, 2)));
  context.run();
  EXPECT_EQ(a.eyes->acks.size(), 20u);
  ASSERT_EQ(a.eyes->parcels.size(), 1u);
  EXPECT_EQ(a.eyes->parcels[0].group->seq, 20u);
}

TEST_F(RoomTest, OwesASlowViewerChunksAndNotMessages) {
  Guest a = enter(), slow = enter();
  look(slow, view_all(1));
  slow.eyes->forget_parcels();
  edit(a, disc(4, 4, 2));  // takes the one parcel that may be on its way
  for (int i = 0; i < 100; ++i) edit(a, disc(4, 4, 2 + 0.01 * i));
  ASSERT_EQ(slow.eyes->parcels.size(), 1u);
  EXPECT_EQ(slow.eyes->parcels[0].group->seq, 1u);

  room->ready(slow.id);
  ASSERT_EQ(slow.eyes->parcels.size(), 2u);
  EXPECT_EQ(slow.eyes->parcels[1].group->seq, 101u);
  EXPECT_LE(slow.eyes->parcels[1].group_records.size(), 4u);
  EXPECT_EQ(slow.eyes->mesh_hash(), mesh_hash());
}

TEST_F(RoomTest, AnEncodedChunkIsSharedBetweenViewers) {
  Guest a = enter(), b = enter();
  look(a, view_all(1)), look(b, view_all(1));
  edit(a, disc(4, 4, 2));
  EXPECT_EQ(a.eyes->parcels.back().group_records[0].get(),
            b.eyes->parcels.back().group_records[0].get());
}

TEST_F(RoomTest, AnUnchangedMeshIsNeitherSentNorRevised) {
  Guest a = enter();
  edit(a, box(4, 4, 3));
  look(a, view_all(1));
  a.eyes->forget_parcels();
  // There and back, before anybody looked.
  ASSERT_TRUE(submit(a, box(4.5, 4.5, 0.25, false)) && submit(a, box(4, 4, 3)));
  context.run();
  EXPECT_EQ(a.eyes->grouped(), 0u);
  while (!room->refresh_meshes(10)) {
  }
  EXPECT_EQ(decoded(room->meshes().records.at(0)).revision, 1u);
}

TEST_F(RoomTest, AMeshThatWasSentInAGroupIsNotSentAgain) {
  Guest a = enter();
  look(a, view_all(1));
  edit(a, box(4, 4, 3));
  settle(a);
  a.eyes->forget_parcels();
  ASSERT_TRUE(submit(a, box(4.5, 4.5, 0.25, false)) && submit(a, box(4, 4, 3)));
  context.run();
  EXPECT_EQ(a.eyes->grouped(), 0u);
}

TEST_F(RoomTest, ACrowdOfEditsIsTakenInTurns) {
  Guest a = enter();
  look(a, view_all(1));
  a.eyes->forget_parcels();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(submit(a, disc(4, 4, 2 + 0.001 * i)));
  settle(a);
  EXPECT_EQ(a.eyes->acks.size(), 2000u);
  EXPECT_EQ(a.eyes->acks.back(), (protocol::Applied{2000, 2000}));
  // One after the first turn, and one for all that followed while it was on its way.
  ASSERT_EQ(a.eyes->parcels.size(), 2u);
  EXPECT_LT(a.eyes->parcels[0].group->seq, 2000u);
  EXPECT_EQ(a.eyes->parcels[1].group->seq, 2000u);
}

TEST_F(RoomTest, AChunkThatBecameEmptyIsSentAsRemoved) {
  Guest a = enter();
  edit(a, disc(4, 4, 2));
  look(a, view_all(1));
  EXPECT_EQ(a.eyes->chunks.size(), 1u);
  edit(a, disc(4, 4, 4, false));
  const Parcel& last = a.eyes->parcels.back();
  ASSERT_EQ(last.group_records.size(), 1u);
  const auto record = decoded(last.group_records[0]);
  EXPECT_TRUE(record.removed);
  EXPECT_EQ(record.revision, 2u);
  EXPECT_TRUE(a.eyes->chunks.empty());
  EXPECT_EQ(mesh_hash(), 0u);
}

TEST_F(RoomTest, SaysHowFarItIsAtMostTenTimesASecond) {
  Guest a = enter();
  look(a, view_all(1));
  a.eyes->forget_parcels();
  int groups = 0;
  for (int i = 0; i < 200; ++i) {
    edit(a, disc(4, 4, 2, false));  // nothing is there
    context.advance(10ms);
    settle(a);
    groups = static_cast<int>(a.eyes->parcels.size());
  }
  EXPECT_GE(groups, 15);
  EXPECT_LE(groups, 20);
  EXPECT_TRUE(a.eyes->parcels.back().group_records.empty());
  context.advance(200ms);
  settle(a);
  EXPECT_EQ(a.eyes->parcels.back().group->seq, 200u);
}

TEST_F(RoomTest, IsQuietWhenNothingHappens) {
  Guest a = enter();
  edit(a, disc(4, 4, 2));
  look(a, view_all(1));
  context.advance(1s);
  const std::size_t before = a.eyes->parcels.size();
  context.advance(10s);
  EXPECT_EQ(a.eyes->parcels.size(), before);
}

TEST_F(RoomTest, ALeaverIsToldNothingMore) {
  Guest a = enter(), b = enter();
  look(b, view_all(1));
  b.eyes->forget_parcels();
  ASSERT_TRUE(submit(b, disc(4, 4, 2)));
  room->leave(b.id);
  context.run();
  EXPECT_TRUE(b.eyes->acks.empty());
  EXPECT_TRUE(b.eyes->parcels.empty());
  EXPECT_EQ(room->info().seq, 1u);  // what was taken stays
  EXPECT_FALSE(submit(b, disc(4, 4, 2)));
}

TEST_F(RoomTest, ALeaverMayWaitForItsNumbers) {
  Guest a = enter(), b = enter();
  look(b, view_all(1));
  b.eyes->forget_parcels();
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(submit(b, disc(4, 4, 2)));  // more than one turn
  std::size_t told = 0, users = 0;
  room->leave_when_told(b.id, [&] { told = b.eyes->acks.size(), users = room->info().users; });
  EXPECT_EQ(room->info().users, 2u);
  edit(a, disc(9, 4, 2));
  EXPECT_EQ(told, 1000u);
  EXPECT_EQ(users, 1u);
  EXPECT_TRUE(b.eyes->parcels.empty());
  EXPECT_EQ(room->info().seq, 1001u);
}

TEST_F(RoomTest, ALeaverWhoWaitsForNothingIsGoneAtOnce) {
  Guest a = enter();
  edit(a, disc(4, 4, 2));
  int gone = 0;
  room->leave_when_told(a.id, [&] { ++gone; });
  EXPECT_EQ(gone, 1);
  EXPECT_EQ(room->info().users, 0u);
  room->leave_when_told(a.id, [&] { ++gone; });
  EXPECT_EQ(gone, 2);
}

TEST_F(RoomTest, EditsThatChangeNothingAreTakenInTurnsToo) {
  Guest a = enter();
  protocol::Edit wide = disc(0, 0, 160, false);  // 42 x 42 chunks of 8 rows
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(submit(a, wide));
  std::uint64_t between = 0;
  room->strand().post([&] { between = room->info().seq; });
  context.run();
  EXPECT_EQ(between, 19u);
  EXPECT_EQ(room->info().seq, 30u);
}

TEST_F(RoomTest, SoManyPointsMayWaitAndNotOneMore) {
  Guest a = enter(), b = enter();
  protocol::Edit longest = disc(0, 0, 0, false);
  longest.is_path = true;
  longest.path.assign(1024, {0, 0});
  for (std::size_t i = 0; i < 4096; ++i) ASSERT_TRUE(submit(i % 2 ? a : b, longest)) << i;
  const auto refused = submit(b, disc(4, 4, 2));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_large);
  EXPECT_NE(refused.error().detail.find("4194304"), std::string::npos);
  context.run();
  EXPECT_EQ(a.eyes->acks.size(), 2048u);
  for (std::size_t i = 0; i < 4096; ++i) ASSERT_TRUE(submit(a, longest)) << i;
}

TEST(Room, AMistakeOfItsOwnClosesItWithAWord) {
  /// Has no time to tell once it is broken.
  struct Broken final : Strand {
    explicit Broken(std::unique_ptr<Strand> strand) : inner(std::move(strand)) {}
    void post(Task task) override { inner->post(std::move(task)); }
    void post_aside(Task task) override { inner->post_aside(std::move(task)); }
    void post_after(std::chrono::milliseconds delay, Task task) override {
      inner->post_after(delay, std::move(task));
    }
    std::int64_t now_ms() const override {
      if (broken) throw std::runtime_error("broken");
      return inner->now_ms();
    }
    std::unique_ptr<Strand> inner;
    bool broken = false;
  };
  ManualContext context;
  auto strand = std::make_unique<Broken>(context.make_strand());
  Broken& clock = *strand;
  const auto room = std::make_shared<Room>("m", open_in_memory(identity_of({})), std::move(strand),
                                           std::make_shared<Meters>());
  const auto eyes = std::make_shared<Onlooker>();
  const ViewerId viewer = room->join(eyes, {}).value().viewer;
  ASSERT_TRUE(room->submit(viewer, {1, 7, disc(4, 4, 2)}));
  clock.broken = true;
  EXPECT_THROW(context.run(), std::runtime_error);
  ASSERT_TRUE(eyes->bye);
  EXPECT_EQ(eyes->bye->failure.code, Code::internal);
  EXPECT_EQ(room->join(eyes, {}).error().code, Code::internal);
}

TEST_F(RoomTest, SaysByeWhenItIsClosed) {
  Guest a = enter();
  room->close({{Code::unknown_map, "the map was deleted", "map"}, {}});
  ASSERT_TRUE(a.eyes->bye);
  EXPECT_EQ(a.eyes->bye->failure.code, Code::unknown_map);
  const auto late = room->join(a.eyes, {});
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, Code::unknown_map);
}

TEST_F(RoomTest, RefusesAViewOfTooManyChunks) {
  Guest a = enter();
  // 128 x 128 chunks of 8 voxels, and one column more.
  EXPECT_TRUE(room->look(a.id, view_rect(1, {1, 1, 1023, 1023})));
  const auto refused = room->look(a.id, view_rect(1, {1, 1, 1031, 1023}));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "rect");
  EXPECT_NE(refused.error().detail.find("16384"), std::string::npos);
}

TEST(Room, RefusesAllOfAMapWithTooManyChunks) {
  World world({.chunk_resolution = 8, .chunks = {{0, 0, 129, 128}}});
  World::Guest a = world.enter();
  for (int i = 0; i < 64; ++i) world.edit(a, box(64 + 128 * (i % 8), 64 + 128 * (i / 8), 63.5));
  ASSERT_EQ(world.room->info().chunks, 16384u);  // 128 x 128, every one full
  EXPECT_TRUE(world.room->look(a.id, view_all(1)));
  world.edit(a, disc(1030, 500, 1));
  const auto refused = world.room->look(a.id, view_all(1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "all");
  EXPECT_NE(refused.error().detail.find("16384"), std::string::npos);
}

TEST_F(RoomTest, FiguresAndMeshesAreOfOneSeq) {
  Guest a = enter();
  edit(a, box(8, 8, 5));
  while (!room->refresh_meshes(1)) {
  }
  const RoomFigures figures = room->figures();
  EXPECT_EQ(figures.seq, 1u);
  EXPECT_NEAR(figures.geometry.surface_area, 100, 1e-3);
  EXPECT_NEAR(figures.geometry.wall_length, 40, 1e-3);
  EXPECT_EQ(figures.meshes.chunks, 4u);
  EXPECT_EQ(room->meshes().records.size(), 4u);
  EXPECT_EQ(figures.meshes.hash, room->meshes().mesh_hash);
  EXPECT_GT(figures.voxel_bytes, 0u);
}

/// Neighbours never come apart, and everybody ends with the same mesh, whoever reads how slowly.
TEST(Room, KeepsEveryViewerWhole) {
  EXPECT_TRUE(rc::check([] {
    World world;
    World::Guest painter = world.enter(), quick = world.enter(), slow = world.enter();
    world.look(quick, view_all(1)), world.look(slow, view_all(1));
    const int edits = *rc::gen::inRange(1, 25);
    for (int i = 0; i < edits; ++i) {
      const double x = *rc::gen::inRange(0, 320) / 8.0, y = *rc::gen::inRange(0, 320) / 8.0;
      const double radius = *rc::gen::inRange(0, 70) / 8.0;
      const bool fill = *rc::gen::weightedElement<bool>({{2, true}, {1, false}});
      const bool square = *rc::gen::arbitrary<bool>();
      RC_ASSERT(world.submit(painter, square ? box(x, y, radius, fill) : disc(x, y, radius, fill)));
      if (*rc::gen::arbitrary<bool>()) world.context.run();
      if (*rc::gen::inRange(0, 4) == 0) world.room->ready(slow.id);
      world.room->ready(quick.id);
      RC_ASSERT(torn_rim(quick.eyes->chunks, 8) == "");
      RC_ASSERT(torn_rim(slow.eyes->chunks, 8) == "");
    }
    world.settle(quick), world.settle(slow);
    RC_ASSERT(quick.eyes->mesh_hash() == world.mesh_hash());
    RC_ASSERT(slow.eyes->mesh_hash() == world.mesh_hash());
  }));
}

}  // namespace
}  // namespace earthwork::room
