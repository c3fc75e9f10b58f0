// A room's talk: who is there, where they point, what was accepted; and viewers who fail.
#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>

#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

protocol::Cursor at(double x, double y) {
  return {.at = {{x, y}}, .brush = {}, .view = {}, .id = {}};
}

/// Throws at what it is told to.
struct Broken final : Viewer {
  enum class At { answered, deliver, tell };
  explicit Broken(At what) : at(what) {}
  void answered(std::vector<Reply>) override { called(At::answered); }
  void deliver(Parcel) override { called(At::deliver); }
  void tell(Talk) override { called(At::tell); }
  void settings(SharedText) override {}
  void end(protocol::Bye bye) override { code = bye.failure.code; }
  void called(At here) const {
    if (here == at) throw std::runtime_error("broken");
  }
  At at;
  std::optional<Code> code;
};

struct TalkTest : testing::Test, World {
  /// They are told all that there is to tell, and forget it.
  void hush(std::initializer_list<Guest*> guests) {
    context.advance(1s);
    for (Guest* guest : guests) {
      room->heard(guest->id);
      guest->eyes->talks.clear();
    }
  }
};

TEST_F(TalkTest, TellsTheOthersWhoCameAndWhoLeft) {
  Guest ann = enter("ann");
  hush({&ann});
  Guest bob = enter("bob");
  context.advance(1s);
  ASSERT_EQ(ann.eyes->people().size(), 1u);
  ASSERT_EQ(ann.eyes->people()[0].users.size(), 1u);
  EXPECT_EQ(ann.eyes->people()[0].users[0].name, "bob");
  EXPECT_TRUE(bob.eyes->talks.empty());
  room->heard(ann.id);
  room->leave(bob.id);
  context.advance(1s);
  ASSERT_EQ(ann.eyes->people().size(), 2u);
  EXPECT_EQ(ann.eyes->people()[1].left, std::vector<std::string>{"0000000000000008"});
}

TEST_F(TalkTest, ALeaverWhoWaitsForItsNumbersIsGoneForTheOthers) {
  Guest ann = enter("ann"), bob = enter("bob");
  hush({&ann, &bob});
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(submit(bob, disc(4, 4, 2)));  // more than one turn
  ASSERT_TRUE(room->follow(bob.id, 1));
  ASSERT_TRUE(room->point(bob.id, at(1, 1)));
  int gone = 0;
  room->leave_when_told(bob.id, [&] { ++gone; });
  context.advance(1s);
  EXPECT_EQ(gone, 1);
  EXPECT_EQ(bob.eyes->acks.size(), 1000u);
  EXPECT_TRUE(bob.eyes->talks.empty());
  EXPECT_EQ(ann.eyes->people().at(0).left.size(), 1u);
  EXPECT_TRUE(ann.eyes->people().at(0).cursors.empty());
}

TEST_F(TalkTest, ShowsWhereTheOthersPoint) {
  Guest ann = enter("ann"), bob = enter("bob");
  hush({&ann, &bob});
  ASSERT_TRUE(room->point(bob.id, at(3, -4)));
  context.run();
  ASSERT_EQ(ann.eyes->people().size(), 1u);
  EXPECT_EQ(ann.eyes->people()[0].cursors[0].at, (protocol::MapPoint{3, -4}));
}

TEST(Talk, ACursorGoesAsFarAsAnEditAndNoFurther) {
  World world({.chunks = {}, .voxel_size = 0.5});
  World::Guest ann = world.enter();
  EXPECT_TRUE(world.room->point(ann.id, at(500'000, -500'000)));
  const auto refused = world.room->point(ann.id, at(0, -500'000.5));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::out_of_range);
  EXPECT_EQ(refused.error().field, "y");
  EXPECT_NE(refused.error().detail.find("1000000"), std::string::npos);
  EXPECT_EQ(world.room->point(ann.id, at(1e308, 0)).error().field, "x");
  EXPECT_TRUE(world.room->point(ann.id, {.at = {}, .brush = {}, .view = {}, .id = {}}));
  EXPECT_EQ(world.room->point(99, at(0, 0)).error().code, Code::bad_state);
}

TEST(Talk, WhatPeopleSeeGoesAsFarToo) {
  World world({.chunks = {}, .voxel_size = 0.5});
  World::Guest ann = world.enter();
  const auto sees = [&](protocol::MapRect view) {
    return world.room->point(ann.id, {.at = {}, .brush = {}, .view = view, .id = {}});
  };
  EXPECT_TRUE(sees({-500'000, -500'000, 500'000, 500'000}));
  for (const protocol::MapRect& far :
       {protocol::MapRect{-500'000.5, 0, 0, 0}, protocol::MapRect{0, -500'000.5, 0, 0},
        protocol::MapRect{0, 0, 500'000.5, 0}, protocol::MapRect{0, 0, 0, 500'000.5},
        protocol::MapRect{-1e308, 0, 1e308, 0}}) {
    const auto refused = sees(far);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::out_of_range);
    EXPECT_EQ(refused.error().field, "view");
    EXPECT_NE(refused.error().detail.find("1000000"), std::string::npos);
  }
}

TEST_F(TalkTest, WhatIsSaidReachesAllAndWhoComesLater) {
  Guest ann = enter("ann"), bob = enter("bob");
  hush({&ann, &bob});
  ASSERT_TRUE(room->say(bob.id, "hello"));
  EXPECT_EQ(meters->chat_lines, 1u);
  context.run();
  ASSERT_EQ(ann.eyes->chat().size(), 1u);
  EXPECT_EQ(ann.eyes->chat()[0].name, "bob");
  EXPECT_EQ(ann.eyes->chat()[0].session, "0000000000000008");
  EXPECT_EQ(bob.eyes->chat(), ann.eyes->chat());
  room->leave(bob.id);
  EXPECT_EQ(room->say(bob.id, "again").error().code, Code::bad_state);
  Guest cem = enter("cem");
  context.run();  // no time passes
  EXPECT_EQ(cem.eyes->chat(), ann.eyes->chat());
}

TEST_F(TalkTest, WhoTalksIsNotAlone) {
  Guest ann = enter("ann");
  context.advance(10s);
  ASSERT_TRUE(room->say(ann.id, "hello"));
  EXPECT_EQ(room->last_used_ms(), 10'000);
}

TEST_F(TalkTest, EventsComeFromWhereTheyAreAskedFor) {
  Guest ann = enter("ann"), bob = enter("bob");
  hush({&ann, &bob});
  edit(ann, disc(4, 4, 2)), edit(ann, disc(5, 4, 2)), edit(ann, disc(6, 4, 2));
  ASSERT_TRUE(room->follow(bob.id, 2));
  context.run();
  ASSERT_EQ(bob.eyes->events().size(), 2u);
  EXPECT_EQ(bob.eyes->events()[0].seq, 2u);
  EXPECT_EQ(bob.eyes->events()[0].action, protocol::Action(disc(5, 4, 2)));
  EXPECT_EQ(bob.eyes->events()[0].author, "0000000000000007");
  room->heard(bob.id);
  ASSERT_TRUE(submit(ann, disc(7, 4, 2)));
  context.run();  // within the turn that applied it
  ASSERT_EQ(bob.eyes->events().size(), 3u);
  EXPECT_EQ(bob.eyes->events()[2].hash, protocol::hex(room->info().hash));
  EXPECT_TRUE(ann.eyes->events().empty());
}

TEST_F(TalkTest, EventsAreAskedForUpToTheNextOne) {
  Guest ann = enter("ann");
  edit(ann, disc(4, 4, 2));
  EXPECT_TRUE(room->follow(ann.id, 2));
  for (const std::uint64_t seq : {std::uint64_t{0}, std::uint64_t{3}}) {
    const auto refused = room->follow(ann.id, seq);
    ASSERT_FALSE(refused) << seq;
    EXPECT_EQ(refused.error().code, Code::out_of_range);
    EXPECT_EQ(refused.error().field, "from_seq");
  }
  EXPECT_EQ(room->follow(99, 1).error().code, Code::bad_state);
}

TEST_F(TalkTest, WhoAsksWhileATalkIsOnItsWayIsToldAfterIt) {
  Guest ann = enter("ann");
  edit(ann, disc(4, 4, 2)), edit(ann, disc(5, 4, 2));
  ASSERT_TRUE(room->follow(ann.id, 1));
  context.run();
  ASSERT_TRUE(room->follow(ann.id, 2));
  context.run();
  EXPECT_EQ(ann.eyes->events().size(), 2u);
  room->heard(ann.id);
  ASSERT_EQ(ann.eyes->events().size(), 3u);
  EXPECT_EQ(ann.eyes->events()[2].seq, 2u);
}

TEST_F(TalkTest, SmallEditsDoNotWaitForTheCrowdOfAnother) {
  Guest ann = enter("ann"), bob = enter("bob");
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(submit(ann, disc(0, 0, 240)));  // each a turn
  ASSERT_TRUE(submit(bob, disc(4, 4, 2)));
  context.run();
  ASSERT_EQ(bob.eyes->acks.size(), 1u);
  EXPECT_LE(bob.eyes->acks[0].seq, 2u);
  EXPECT_EQ(ann.eyes->acks.back().seq, 21u);
}

TEST_F(TalkTest, KnowsHowBusyItIs) {
  Guest ann = enter("ann"), bob = enter("bob");
  look(bob, view_all(1));
  edit(ann, disc(4, 4, 2));
  ASSERT_TRUE(submit(ann, disc(8, 8, 2)) && submit(ann, disc(9, 8, 2)));
  context.advance(0ms);
  EXPECT_EQ(room->load().waiting_edits, 0u);
  ASSERT_TRUE(submit(ann, disc(8, 8, 3)) && submit(ann, disc(9, 8, 3)));
  const RoomLoad load = room->load();
  EXPECT_EQ(load.waiting_edits, 2u);
  EXPECT_EQ(load.oldest_wait_ms, 0);  // none has passed
  EXPECT_EQ(load.viewers, 2u);
  EXPECT_GT(load.owed_chunks, 0u);  // bob has not taken the group before
}

TEST_F(TalkTest, AViewerThatThrowsIsGoneAndTheOthersGoOn) {
  for (const auto what : {Broken::At::answered, Broken::At::deliver, Broken::At::tell}) {
    Guest ann = enter("ann");
    look(ann, view_all(1));
    const auto broken = std::make_shared<Broken>(what);
    const ViewerId id = room->join(broken, {"00000000000000bb", "bob", {}, {}}).value().viewer;
    ASSERT_TRUE(room->look(id, view_all(1)) && room->follow(id, 1));
    ASSERT_TRUE(room->submit(id, {1, 1000 + id, disc(4, 4, 2)}));
    int gone = 0;
    if (what == Broken::At::answered) room->leave_when_told(id, [&] { ++gone; });
    edit(ann, disc(30 + 9 * static_cast<double>(id), 9, 3));
    context.advance(1s);
    settle(ann);
    EXPECT_EQ(broken->code, Code::internal);
    EXPECT_EQ(gone, 0);  // it was told `end` in its place
    EXPECT_FALSE(room->look(id, view_all(2)));
    EXPECT_EQ(ann.eyes->acks.size(), 1u);
    EXPECT_EQ(ann.eyes->mesh_hash(), mesh_hash());
    EXPECT_FALSE(ann.eyes->bye);
    room->leave(ann.id);
    EXPECT_EQ(room->info().users, 0u);
  }
}

TEST_F(TalkTest, ASlowViewerKeepsNobodyWaiting) {
  Guest ann = enter("ann"), slow = enter("slow");
  ASSERT_TRUE(room->follow(ann.id, 1) && room->follow(slow.id, 1));
  context.advance(1s);
  for (int i = 1; i <= 100; ++i) {
    room->heard(ann.id);
    edit(ann, disc(i, 4, 2));
  }
  room->heard(ann.id);
  EXPECT_EQ(ann.eyes->events().size(), 100u);
  EXPECT_LE(slow.eyes->talks.size(), 1u);
}

TEST_F(TalkTest, SaysNothingOnceItIsClosed) {
  Guest ann = enter("ann"), bob = enter("bob");
  ASSERT_TRUE(room->follow(ann.id, 1));
  ASSERT_TRUE(submit(bob, disc(4, 4, 2)));
  int gone = 0;
  room->leave_when_told(bob.id, [&] { ++gone; });
  room->close({{Code::unknown_map, "the map was deleted", "map"}, {}});
  context.advance(60s);
  EXPECT_TRUE(ann.eyes->talks.empty());
  EXPECT_TRUE(ann.eyes->bye && bob.eyes->bye);
  EXPECT_EQ(gone, 0);
  EXPECT_TRUE(bob.eyes->acks.empty());
}

}  // namespace
}  // namespace earthwork::room
