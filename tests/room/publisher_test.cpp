// Showing a map in rounds: what is shown while one runs, who waits for whom, and that everybody
// ends with the whole map.
#include "server/room/publisher.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;

/// A disc in the middle of each of 20 x 20 chunks of 8 voxels, and a viewer who has seen them.
struct PublisherTest : testing::Test, World {
  PublisherTest() : painter(enter("painter")), seen(enter("seen")) {
    for (int x = 0; x < 20; ++x)
      for (int y = 0; y < 20; ++y) edit(painter, dot(x, y));
    look(seen, view_rect(1, {1, 1, 159, 159}));
    seen.eyes->forget_parcels();
  }
  static protocol::Edit dot(int x, int y) { return disc(8 * x + 4.5, 8 * y + 4.5, 2); }
  static protocol::Edit large(bool fill = false) { return box(80, 80, 60, fill); }
  void run_a_few() { context.run(3); }  // a turn, and the first slices

  Guest painter, seen;
};

TEST_F(PublisherTest, ASmallEditIsShownInItsOwnTurn) {
  ASSERT_TRUE(submit(painter, disc(40, 40, 3)));
  context.run(1);
  ASSERT_EQ(seen.eyes->parcels.size(), 1u);
  EXPECT_EQ(seen.eyes->parcels[0].group->seq, 401u);
  EXPECT_EQ(context.run(), 0);
}

TEST_F(PublisherTest, ALargeEditIsAcknowledgedBeforeItIsMeshed) {
  ASSERT_TRUE(submit(painter, large()));
  context.run(1);
  EXPECT_EQ(painter.eyes->acks.back().seq, 401u);
  EXPECT_TRUE(seen.eyes->parcels.empty());
  const std::uint64_t meshed = meters->meshed_chunks;
  context.run();
  ASSERT_EQ(seen.eyes->parcels.size(), 1u);
  EXPECT_EQ(seen.eyes->parcels[0].group->seq, 401u);
  EXPECT_GE(seen.eyes->parcels[0].group_records.size(), 225u);
  EXPECT_GE(meters->meshed_chunks - meshed, 225u);
  EXPECT_EQ(seen.eyes->mesh_hash(), mesh_hash());
}

TEST_F(PublisherTest, EditsGoOnDuringARoundAndComeInTheNext) {
  ASSERT_TRUE(submit(painter, large()));
  run_a_few();
  ASSERT_TRUE(submit(painter, disc(80, 80, 3)));  // where the round is at work, and outside
  ASSERT_TRUE(submit(painter, disc(4.5, 4.5, 3)));
  for (int task = 0; painter.eyes->acks.back().seq < 403u; ++task) {
    ASSERT_LT(task, 10);
    context.run(1);
  }
  EXPECT_TRUE(seen.eyes->parcels.empty());
  context.run();
  ASSERT_EQ(seen.eyes->parcels.size(), 1u);
  EXPECT_EQ(seen.eyes->parcels[0].group->seq, 401u);
  EXPECT_EQ(torn_rim(seen.eyes->chunks, 8), "");
  room->ready(seen.id);
  ASSERT_EQ(seen.eyes->parcels.size(), 2u);
  EXPECT_EQ(seen.eyes->parcels[1].group->seq, 403u);
  EXPECT_EQ(seen.eyes->mesh_hash(), mesh_hash());
}

TEST_F(PublisherTest, WhoWaitsForNothingOfARoundIsNotKeptWaiting) {
  Guest corner = enter("corner");
  ASSERT_TRUE(submit(painter, large()));
  run_a_few();
  ASSERT_TRUE(room->look(corner.id, view_rect(1, {1, 1, 7, 7})));
  context.run(6);
  // Its one chunk is made already.
  EXPECT_EQ(corner.eyes->first_seen(), 1u);
  ASSERT_TRUE(corner.eyes->parcels.back().caught_up);
  EXPECT_TRUE(seen.eyes->parcels.empty());
  context.run();
}

TEST_F(PublisherTest, FiguresAreOfTheMapAsItIsWhateverRuns) {
  ASSERT_TRUE(submit(painter, large()));
  run_a_few();
  ASSERT_TRUE(submit(painter, disc(80, 80, 3)));
  while (painter.eyes->acks.back().seq < 402u) context.run(1);
  EXPECT_TRUE(seen.eyes->parcels.empty());
  EXPECT_FALSE(room->refresh_meshes(1));
  while (!room->refresh_meshes(7)) {
  }
  EXPECT_EQ(room->load().dirty_chunks, 0u);
  const std::uint64_t hash = room->meshes().mesh_hash;
  EXPECT_EQ(room->figures().seq, 402u);
  settle(seen);
  EXPECT_EQ(seen.eyes->mesh_hash(), hash);
  EXPECT_EQ(mesh_hash(), hash);
}

TEST_F(PublisherTest, ARoomMayGoWhileARoundRuns) {
  ASSERT_TRUE(submit(painter, large()));
  run_a_few();
  room->close({{protocol::Code::unknown_map, "the map was deleted", "map"}, {}});
  std::weak_ptr<Room> weak = room;
  room.reset();
  context.run();
  EXPECT_TRUE(weak.expired());
  EXPECT_TRUE(seen.eyes->parcels.empty());
  EXPECT_TRUE(seen.eyes->bye);
}

TEST_F(PublisherTest, AViewerMayLeaveWhileItsRoundRuns) {
  ASSERT_TRUE(submit(painter, large()));
  run_a_few();
  room->leave(seen.id);
  context.run();
  EXPECT_TRUE(seen.eyes->parcels.empty());
  Guest late = enter("late");
  look(late, view_all(1));
  EXPECT_EQ(late.eyes->mesh_hash(), mesh_hash());
}

/// A flood of edits everywhere, and somebody who looks for the first time at what nobody has seen.
TEST(Publisher, AFirstLoadEndsHoweverFastEditsCome) {
  World world;
  World::Guest painter = world.enter("painter"), fresh = world.enter("fresh");
  for (int i = 0; i < 9; ++i) world.edit(painter, box(53.3 * (i % 3), 53.3 * (i / 3), 40));
  ASSERT_TRUE(world.room->look(fresh.id, view_all(1)));
  const auto caught_up = [&] {
    return !fresh.eyes->parcels.empty() && fresh.eyes->parcels.back().caught_up.has_value();
  };
  int steps = 0;
  for (; !caught_up(); ++steps) {
    ASSERT_LT(steps, 150);
    for (int i = 0; i < 16; ++i)  // no chunk stays as it is
      ASSERT_TRUE(world.submit(
          painter, disc(20 + 40 * (i % 4), 20 + 40 * (i / 4), 18 + steps % 10, steps % 2 == 0)));
    world.context.run(8);  // a round takes several such steps
    world.room->ready(fresh.id);
  }
  EXPECT_GE(steps, 30);
  EXPECT_EQ(torn_rim(fresh.eyes->chunks, 8), "");
  EXPECT_GE(fresh.eyes->grouped(), 64u);
  world.context.run();
  world.settle(fresh);
  EXPECT_EQ(fresh.eyes->mesh_hash(), world.mesh_hash());
}

TEST(Publisher, ManyFirstLoadsTakeTurns) {
  World world;
  World::Guest painter = world.enter("painter");
  for (int i = 0; i < 36; ++i) world.edit(painter, box(80 * (i % 6), 80 * (i / 6), 40));
  std::vector<World::Guest> guests;
  for (int i = 0; i < 9; ++i) guests.push_back(world.enter());
  for (std::size_t i = 0; i < guests.size(); ++i) {  // views apart from one another
    const double x = 150.0 * static_cast<double>(i % 3), y = 150.0 * static_cast<double>(i / 3);
    ASSERT_TRUE(world.room->look(guests[i].id, view_rect(1, {x, y, x + 130, y + 130})));
  }
  const auto done = [&](const World::Guest& guest) { return guest.eyes->first_seen() >= 250; };
  for (int steps = 0; std::none_of(guests.begin(), guests.end(), done); ++steps) {
    ASSERT_LT(steps, 1000);
    world.context.run(4);
    for (World::Guest& guest : guests) world.room->ready(guest.id);
  }
  for (const World::Guest& guest : guests) EXPECT_GE(guest.eyes->first_seen(), 128u);
}

/// With 100 viewers the room rests for 4 ms after it has shown something.
struct CrowdTest : PublisherTest {
  CrowdTest() {
    for (int i = 0; i < 98; ++i) crowd.push_back(enter());
    context.advance(1s);
  }
  std::uint64_t seq_shown() const { return seen.eyes->parcels.back().group->seq; }

  std::vector<Guest> crowd;
};

TEST_F(CrowdTest, IsShownAtOnceWhatComesAfterARest) {
  edit(painter, disc(40, 40, 3));
  ASSERT_EQ(seen.eyes->parcels.size(), 1u);
  EXPECT_EQ(seq_shown(), 401u);
}

TEST_F(CrowdTest, IsShownTogetherWhatComesDuringOne) {
  edit(painter, disc(40, 40, 3));
  room->ready(seen.id);
  for (int i = 0; i < 5; ++i) edit(painter, disc(40 + i, 44, 3));
  context.advance(3ms);
  EXPECT_EQ(seen.eyes->parcels.size(), 1u);
  EXPECT_EQ(painter.eyes->acks.back().seq, 406u);  // nobody waits for a number
  context.advance(1ms);
  ASSERT_EQ(seen.eyes->parcels.size(), 2u);
  EXPECT_EQ(seq_shown(), 406u);
  EXPECT_EQ(seen.eyes->mesh_hash(), mesh_hash());
}

TEST_F(CrowdTest, IsNeverShownAMeshOfTheMapThatRests) {
  edit(painter, disc(40, 40, 3));
  edit(painter, large());  // rests
  room->ready(seen.id);
  ASSERT_TRUE(room->look(crowd[0].id, view_rect(1, {1, 1, 159, 159})));
  context.advance(3ms);
  EXPECT_EQ(seen.eyes->parcels.size(), 1u);
  context.advance(1ms);
  EXPECT_EQ(seq_shown(), 402u);
  settle(crowd[0]);
  EXPECT_EQ(torn_rim(crowd[0].eyes->chunks, 8), "");
  EXPECT_EQ(crowd[0].eyes->mesh_hash(), mesh_hash());
}

TEST(Publisher, NoCrowdRestsForLongerThanATwentiethOfASecond) {
  World world;
  World::Guest painter = world.enter("painter");
  for (int i = 0; i < 2000; ++i) (void)world.enter();
  world.look(painter, view_all(1));
  painter.eyes->forget_parcels();
  world.edit(painter, disc(40, 40, 3));
  world.room->ready(painter.id);
  world.edit(painter, disc(44, 40, 3));
  world.context.advance(49ms);
  EXPECT_EQ(painter.eyes->parcels.size(), 1u);
  world.context.advance(1ms);
  EXPECT_EQ(painter.eyes->parcels.size(), 2u);
}

TEST_F(CrowdTest, IsToldASeqThatAnExportTookIn) {
  edit(painter, disc(40, 40, 3));
  room->ready(seen.id);
  edit(painter, disc(40, 40, 3));  // changes nothing, and rests
  while (!room->refresh_meshes(100)) {
  }
  context.advance(1s);
  EXPECT_EQ(seq_shown(), 402u);
}

/// What a viewer was given, step by step.
void check_steps(const World::Guest& guest, std::size_t& checked, std::uint64_t& told,
                 const World& world) {
  for (; checked < guest.eyes->parcels.size(); ++checked) {
    const Parcel& parcel = guest.eyes->parcels[checked];
    if (parcel.group) {
      RC_ASSERT(parcel.group->seq > told);
      told = parcel.group->seq;
      for (const RecordBytes& bytes : parcel.group_records)
        if (!is_delta(bytes)) RC_ASSERT(decoded(bytes).revision <= told);
    }
    if (parcel.caught_up) {
      RC_ASSERT(parcel.caught_up->seq >= told);
      told = parcel.caught_up->seq;
    }
  }
  RC_ASSERT(told <= world.room->info().seq);
}

/// However turns, slices, views and slow readers interleave: neighbours never come apart, seqs
/// rise, and all end with the map as it is.
TEST(Publisher, KeepsEveryViewerWholeWhateverComesWhen) {
  EXPECT_TRUE(rc::check([] {
    World world;
    World::Guest painter = world.enter();
    std::vector<World::Guest> guests{world.enter(), world.enter(), world.enter()};
    const int crowd = *rc::gen::weightedElement<int>({{3, 0}, {1, 50}});  // with one, it rests
    for (int i = 0; i < crowd; ++i) (void)world.enter();
    std::vector<std::size_t> checked(3, 0);
    std::vector<std::uint64_t> told(3, 0);
    std::vector<bool> loaded(3, false);
    std::uint32_t n = 0;
    const auto check = [&] {
      for (std::size_t i = 0; i < guests.size(); ++i) {
        check_steps(guests[i], checked[i], told[i], world);
        const auto& parcels = guests[i].eyes->parcels;
        if (!parcels.empty() && parcels.back().caught_up) loaded[i] = true;
        if (loaded[i]) RC_ASSERT(torn_rim(guests[i].eyes->chunks, 8) == "");
      }
    };
    // The first one looks from the beginning, so all that it is shown comes in groups.
    RC_ASSERT(world.room->look(guests[0].id, view_all(++n)).has_value());
    const int steps = *rc::gen::inRange(1, 60);
    for (int step = 0; step < steps; ++step) {
      const auto who = static_cast<std::size_t>(*rc::gen::inRange(0, 3));
      switch (*rc::gen::weightedElement<int>({{4, 0}, {6, 1}, {2, 2}, {1, 3}, {1, 4}, {1, 5}})) {
        case 0: {
          const double x = *rc::gen::inRange(0, 1000) / 8.0, y = *rc::gen::inRange(0, 1000) / 8.0;
          const double radius = *rc::gen::inRange(0, 500) / 8.0;
          const bool fill = *rc::gen::weightedElement<bool>({{2, true}, {1, false}});
          RC_ASSERT(world.submit(painter, disc(x, y, radius, fill)).has_value());
          break;
        }
        case 1:
          world.context.run(*rc::gen::inRange(1, 12));
          break;
        case 2:
          world.room->ready(guests[who].id);
          break;
        case 3:
          RC_ASSERT(world.room->look(guests[who].id, view_all(++n)).has_value());
          break;
        case 4:
          (void)world.room->refresh_meshes(static_cast<std::size_t>(*rc::gen::inRange(0, 30)));
          break;
        default:
          world.context.advance(std::chrono::milliseconds(*rc::gen::element(1, 2, 100)));
      }
      check();
    }
    world.context.run();
    const std::uint64_t hash = world.mesh_hash();
    for (World::Guest& guest : guests) {
      RC_ASSERT(world.room->look(guest.id, view_all(++n)).has_value());
      world.settle(guest);
    }
    check();
    for (const World::Guest& guest : guests) RC_ASSERT(guest.eyes->mesh_hash() == hash);
  }));
}

}  // namespace
}  // namespace earthwork::room
