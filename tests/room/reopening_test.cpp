// A room that begins with what another one left: it goes on as if there had been no end.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "server/history/fold.hpp"
#include "tests/room/slow_world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

/// A room over the journal of another one.
std::shared_ptr<Room> reopen(const SlowWorld& world, ManualContext& context,
                             journal::Clerk*& its_clerk) {
  auto journal = journal::make_memory_journal(world.journal->identity());
  EXPECT_TRUE(journal->append(0, world.journal->events(1, SIZE_MAX).value()));
  auto restored = journal::restore(*journal, {}, journal::Trust::strict).value();
  auto clerk = journal::immediate_clerk(std::move(journal));
  its_clerk = clerk.get();
  return std::make_shared<Room>("m",
                                Opening{.identity = world.journal->identity(),
                                        .restored = std::move(restored),
                                        .clerk = std::move(clerk),
                                        .commits = Commits::later},
                                context.make_strand(), std::make_shared<Meters>());
}

struct ReopeningTest : testing::Test, SlowWorld {
  ReopeningTest() {
    Guest ann = enter("ann", 77);
    for (int i = 0; i < 5; ++i) edit(ann, disc(4 + 6 * i, 4, 3));
    edit(ann, box(4, 4, 6, false));
    look(watcher, view_all(1));
    commit_all();
    settle(watcher);
    left = room->info();
    left_mesh = mesh_hash();
    room = reopen(*this, context, again);
    last_session = 20;
  }
  Guest watcher = enter("watcher");
  RoomInfo left;
  std::uint64_t left_mesh = 0;
  journal::Clerk* again = nullptr;
};

TEST_F(ReopeningTest, TheMapIsWhatItWas) {
  EXPECT_EQ(room->info().seq, 6u);
  EXPECT_EQ(room->info().hash, left.hash);
  EXPECT_EQ(room->info().chunks, left.chunks);
  Guest bob = enter("bob");
  look(bob, view_all(1));
  EXPECT_EQ(bob.eyes->mesh_hash(), left_mesh);
  EXPECT_EQ(bob.eyes->parcels.back().caught_up->seq, 6u);
}

TEST_F(ReopeningTest, NoMeshIsMadeBeforeSomebodyLooks) {
  const std::uint64_t made = meters->meshed_chunks;
  context.advance(1s);
  Guest bob = enter("bob");
  context.advance(1s);
  EXPECT_EQ(meters->meshed_chunks, made);
  EXPECT_EQ(room->load().dirty_chunks, 0u);  // nothing has changed
  look(bob, view_all(1));
  EXPECT_EQ(bob.eyes->mesh_hash(), left_mesh);
}

TEST_F(ReopeningTest, EditsGoOnWhereTheyEnded) {
  Guest bob = enter("bob");
  ASSERT_TRUE(room->follow(bob.id, 5));
  edit(bob, disc(30, 30, 3));
  EXPECT_EQ(bob.eyes->acks, (std::vector<protocol::Applied>{{1, 7}}));
  context.advance(1s);
  room->heard(bob.id);
  context.run();
  ASSERT_EQ(bob.eyes->events().size(), 3u);
  EXPECT_EQ(bob.eyes->events()[0].seq, 5u);
  EXPECT_EQ(bob.eyes->events()[2].seq, 7u);
  EXPECT_EQ(room->follow(bob.id, 9).error().code, Code::out_of_range);
}

TEST_F(ReopeningTest, AnEditOfBeforeIsKnownAgain) {
  Guest ann = enter("ann", 77);
  ASSERT_TRUE(room->submit(ann.id, {3, 77, disc(99, 99, 9)}));
  context.run();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{3, 3}}));
  EXPECT_EQ(room->info().seq, 6u);
}

TEST_F(ReopeningTest, AClaimOfBeforeIsStillTrue) {
  Guest bob = enter("bob");
  bob.eyes->chunks = watcher.eyes->chunks;
  protocol::View view = view_all(1);
  view.have = protocol::Have{
      .epoch = protocol::hex(room->epoch()), .seq = 6, .rect = {-100, -100, 200, 200}};
  look(bob, view);
  EXPECT_EQ(bob.eyes->first_seen() + bob.eyes->grouped(), 0u);
  edit(bob, disc(16, 4, 5));
  settle(bob);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
}

}  // namespace
}  // namespace earthwork::room
