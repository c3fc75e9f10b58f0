// Durable before seen: what a room says and shows while a commit is under way, and when it fails.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "server/history/fold.hpp"
#include "tests/room/slow_world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

/// Whatever went on: the map is the fold of what is durable.
void check_folds(SlowWorld& world) {
  voxel::Map again = history::make_map(world.room->settings());
  EXPECT_EQ(history::verify(again, world.events()), std::nullopt);
  EXPECT_EQ(again.hash(), world.room->info().hash);
  EXPECT_EQ(again.chunk_count(), world.room->info().chunks);
  while (!world.room->refresh_meshes(1000)) {
  }
  EXPECT_EQ(world.room->figures().hash, again.hash());
}

struct CommitTest : testing::Test, SlowWorld {
  CommitTest() : ann(enter("ann")), bob(enter("bob")) {
    look(bob, view_all(1));
    bob.eyes->forget_parcels();
    EXPECT_TRUE(room->follow(bob.id, 1));
    hear(bob);
    bob.eyes->talks.clear();
  }
  void hear(Guest& guest) {
    context.advance(1s);
    room->heard(guest.id);
    context.run();
  }
  Guest ann, bob;
};

TEST_F(CommitTest, NobodyHearsOfAnEditBeforeItIsDurable) {
  edit(ann, disc(4, 4, 2));
  context.advance(1s);
  EXPECT_TRUE(ann.eyes->acks.empty());
  EXPECT_TRUE(bob.eyes->parcels.empty());
  EXPECT_TRUE(bob.eyes->events().empty());
  EXPECT_EQ(room->info().seq, 0u);
  EXPECT_EQ(room->info().hash, 0u);
  EXPECT_EQ(room->info().chunks, 0u);
  EXPECT_EQ(room->follow(ann.id, 2).error().code, Code::out_of_range);
  EXPECT_EQ(meters->edits, 0u);
  EXPECT_EQ(meters->waiting_events, 1);

  commit();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
  ASSERT_EQ(bob.eyes->parcels.size(), 1u);
  EXPECT_EQ(bob.eyes->parcels[0].group->seq, 1u);
  EXPECT_EQ(bob.eyes->events().size(), 1u);
  EXPECT_EQ(room->info().seq, 1u);
  EXPECT_EQ(room->info().hash, events().back().hash);
  EXPECT_TRUE(room->follow(ann.id, 2));
  EXPECT_EQ(meters->edits, 1u);
  EXPECT_EQ(meters->waiting_events, 0);
}

TEST_F(CommitTest, TellsWhoJoinsWhatIsDurable) {
  edit(ann, disc(4, 4, 2));
  auto late = std::make_shared<Onlooker>();
  const auto joined = room->join(late, {"00000000000000bb", "late", {}, {}}).value();
  EXPECT_EQ(joined.joined.seq, 0u);
  ASSERT_TRUE(room->look(joined.viewer, view_all(1)));
  context.advance(1s);
  EXPECT_TRUE(late->parcels.empty());
  commit();
  ASSERT_FALSE(late->parcels.empty());
  EXPECT_EQ(late->parcels.back().caught_up->seq, 1u);
}

TEST_F(CommitTest, MeshesAreMadeMeanwhile) {
  const std::uint64_t before = meters->meshed_chunks;
  edit(ann, disc(4, 4, 2));
  const std::uint64_t made = meters->meshed_chunks - before;
  EXPECT_GE(made, 1u);
  commit();
  EXPECT_EQ(meters->meshed_chunks - before, made);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
}

TEST_F(CommitTest, WhatWaitsTogetherIsStoredTogether) {
  edit(ann, disc(4, 4, 2));
  for (int i = 0; i < 20; ++i) edit(ann, disc(5 + i, 4, 2));
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(submit(bob, disc(5, 9, 2)));
  context.run();  // two turns and more
  EXPECT_EQ(clerk->waiting(), 1u);
  commit();
  EXPECT_EQ(ann.eyes->acks.size(), 1u);
  commit();
  EXPECT_EQ(fickle->batches, (std::vector<std::size_t>{1, 1020}));
  EXPECT_EQ(ann.eyes->acks.size(), 21u);
  EXPECT_EQ(bob.eyes->acks.size(), 1000u);
  EXPECT_EQ(meters->commits, 2u);
  EXPECT_EQ(meters->committed_events, 1021u);
  check_folds(*this);
}

TEST_F(CommitTest, EditsWaitInLineWhenTooManyHaveGathered) {
  edit(ann, disc(4, 4, 0));
  for (int i = 0; i < 6000; ++i) ASSERT_TRUE(submit(ann, disc(4, 4, 0)));
  context.run();
  EXPECT_EQ(room->load().waiting_edits, 6000u - kMaxGatheredEvents);
  commit_all();
  EXPECT_EQ(ann.eyes->acks.size(), 6001u);
  EXPECT_EQ(fickle->batches, (std::vector<std::size_t>{1, kMaxGatheredEvents, 1904}));
}

TEST_F(CommitTest, SoTheyDoWhenTheyAreLarge) {
  edit(ann, disc(4, 4, 0));
  protocol::Edit longest = disc(0, 0, 0, false);
  longest.is_path = true;
  longest.path.assign(1024, {0, 0});  // 16 KiB
  for (int i = 0; i < 600; ++i) ASSERT_TRUE(submit(ann, longest));
  context.run();
  EXPECT_GE(room->load().waiting_edits, 600u - 512u);
  commit_all();
  EXPECT_EQ(ann.eyes->acks.size(), 601u);
  EXPECT_GE(fickle->batches.size(), 3u);
}

TEST_F(CommitTest, EveryCommitShowsSomethingHoweverFastEditsCome) {
  std::uint64_t shown = 0;
  for (int step = 1; step <= 20; ++step) {
    for (int i = 0; i < 3; ++i) edit(ann, disc(4 + step, 4 + i, 2));
    store();
    edit(ann, disc(4, 4 + step, 2));
    context.run();
    room->ready(bob.id);
    ASSERT_EQ(bob.eyes->parcels.size(), static_cast<std::size_t>(step));
    EXPECT_GT(bob.eyes->parcels.back().group->seq, shown);
    shown = bob.eyes->parcels.back().group->seq;
    EXPECT_LE(shown, room->info().seq);
  }
}

TEST_F(CommitTest, ALargeRoundIsShownHoweverFastCommitsCome) {
  ASSERT_TRUE(submit(ann, box(80, 80, 60)));
  context.run(1);
  for (int step = 0; bob.eyes->parcels.empty(); ++step) {
    ASSERT_LT(step, 200);
    ASSERT_TRUE(submit(ann, disc(80 + step % 7, 80, 3)));
    context.run(2);
    store();
  }
  EXPECT_EQ(bob.eyes->parcels[0].group->seq, 1u);
  commit_all();
  settle(bob);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
}

TEST_F(CommitTest, BeatsAreToldHoweverFastCommitsCome) {
  Guest corner = enter("corner");
  look(corner, view_rect(1, {200, 200, 207, 207}));
  corner.eyes->forget_parcels();
  for (int step = 0; step < 30; ++step) {
    edit(ann, disc(4, 4 + step, 2));
    clerk->run();
    ASSERT_TRUE(submit(ann, disc(9, 4 + step, 2)));
    context.advance(10ms);
    room->ready(corner.id);
  }
  EXPECT_GE(corner.eyes->parcels.size(), 2u);
}

TEST_F(CommitTest, AnswersKeepTheirOrder) {
  edit(ann, disc(4, 4, 2));
  commit();
  ASSERT_TRUE(room->submit(ann.id, {5, ann.author, disc(5, 4, 2)}));
  ASSERT_TRUE(room->submit(ann.id, {1, ann.author, disc(4, 4, 2)}));  // durable for long
  ASSERT_TRUE(room->submit(ann.id, {4, ann.author, disc(6, 4, 2)}));  // below 5
  context.run();
  EXPECT_EQ(ann.eyes->acks.size(), 1u);
  EXPECT_TRUE(ann.eyes->refusals.empty());
  commit();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {5, 2}, {1, 1}}));
  ASSERT_EQ(ann.eyes->refusals.size(), 1u);
  EXPECT_EQ(ann.eyes->refusals[0].failure.code, Code::id_out_of_order);
}

TEST_F(CommitTest, ARepeatedEditIsAnsweredOnceTheFirstIsDurable) {
  edit(ann, disc(4, 4, 2));
  ASSERT_TRUE(room->submit(ann.id, {1, ann.author, disc(4, 4, 2)}));
  context.run();
  EXPECT_TRUE(ann.eyes->acks.empty());
  commit();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {1, 1}}));
  EXPECT_EQ(fickle->batches.size(), 1u);
}

TEST_F(CommitTest, WhoLeavesWhenToldWaitsForTheCommit) {
  edit(ann, disc(4, 4, 2));
  std::size_t told = 99;
  room->leave_when_told(ann.id, [&] { told = ann.eyes->acks.size(); });
  context.run();
  EXPECT_EQ(told, 99u);
  commit();
  EXPECT_EQ(told, 1u);
  EXPECT_EQ(room->info().users, 1u);
}

TEST_F(CommitTest, WhoLeavesMeanwhileIsToldNothing) {
  edit(ann, disc(4, 4, 2));
  room->leave(ann.id);
  commit();
  EXPECT_TRUE(ann.eyes->acks.empty());
  EXPECT_EQ(room->info().seq, 1u);
  EXPECT_EQ(bob.eyes->parcels.size(), 1u);
}

TEST_F(CommitTest, ARoomMayCloseMeanwhile) {
  edit(ann, disc(4, 4, 2));
  edit(ann, disc(9, 4, 2));
  std::vector<bool> told;
  room->once_durable([&](bool kept) { told.push_back(kept); });
  room->close({{Code::shutting_down, "the server ends", {}}, {}});
  EXPECT_EQ(told, std::vector<bool>{false});
  commit_all();
  EXPECT_TRUE(ann.eyes->acks.empty());
  EXPECT_TRUE(ann.eyes->bye && bob.eyes->bye);
  EXPECT_EQ(journal->last_seq(), 1u);  // what was on its way
  room->once_durable([&](bool kept) { told.push_back(kept); });
  EXPECT_EQ(told, (std::vector<bool>{false, false}));
}

TEST_F(CommitTest, ARoomMayGoMeanwhile) {
  edit(ann, disc(4, 4, 2));
  std::weak_ptr<Room> weak = room;
  clerk->run();  // the outcome is on its way to the strand
  room.reset();
  EXPECT_TRUE(weak.expired());
  context.run();
  EXPECT_TRUE(ann.eyes->acks.empty());
  EXPECT_EQ(meters->waiting_events, 0);
}

TEST_F(CommitTest, OnceDurableIsWithinTheCallWhenNothingWaits) {
  int called = 0;
  room->once_durable([&](bool kept) { called += kept ? 1 : 100; });
  EXPECT_EQ(called, 1);
}

TEST_F(CommitTest, OnceDurableWaitsForWhatIsAppliedByThen) {
  std::vector<std::uint64_t> seqs;
  edit(ann, disc(4, 4, 2));
  edit(ann, disc(5, 4, 2));
  room->once_durable([&](bool kept) { seqs.push_back(kept ? room->info().seq : 99); });
  commit();
  EXPECT_TRUE(seqs.empty());
  edit(ann, disc(6, 4, 2));
  commit();
  EXPECT_EQ(seqs, std::vector<std::uint64_t>{2});
  // After what was durable was told, and with meshes of what is on its way.
  room->once_durable([&](bool) {
    seqs.push_back(ann.eyes->acks.size());
    room->once_durable([&](bool) { seqs.push_back(100); });
  });
  commit();
  EXPECT_EQ(seqs, (std::vector<std::uint64_t>{2, 3, 100}));
}

TEST_F(CommitTest, FiguresAreOfWhatIsAppliedAndKeptOnceItIsDurable) {
  edit(ann, disc(4, 4, 2));
  while (!room->refresh_meshes(100)) {
  }
  EXPECT_EQ(room->figures().seq, 1u);
  EXPECT_EQ(room->meshes().seq, 1u);
  bool said = true;
  room->once_durable([&](bool kept) { said = kept; });
  fail();
  EXPECT_FALSE(said);
  wait_out_the_pause();
  edit(ann, box(20, 20, 5));  // another event 1
  while (!room->refresh_meshes(100)) {
  }
  EXPECT_EQ(room->figures().seq, 1u);
  EXPECT_NEAR(room->figures().geometry.surface_area, 100, 1e-3);
}

TEST_F(CommitTest, WhatCannotBeStoredIsRefusedAndGone) {
  edit(ann, disc(4, 4, 2));
  commit();
  settle(bob);
  const std::uint64_t hash = room->info().hash;
  const auto chunks = bob.eyes->chunks;
  bob.eyes->forget_parcels();
  edit(ann, disc(9, 4, 2));                  // in flight
  edit(bob, disc(4, 4, 3));                  // gathered: changes what is durable,
  edit(bob, box(4, 4, 40, false));           // and removes it
  ASSERT_TRUE(submit(ann, disc(30, 4, 2)));  // in line
  fickle->trouble = protocol::Failure{Code::disk_full, "the disk is full", {}};
  store();
  context.run();

  ASSERT_EQ(ann.eyes->refusals.size(), 2u);
  ASSERT_EQ(bob.eyes->refusals.size(), 2u);
  for (const auto& refusal : ann.eyes->refusals)
    EXPECT_EQ(refusal.failure, (protocol::Failure{Code::disk_full, "the disk is full", {}}));
  EXPECT_EQ(ann.eyes->refusals[0].id, 2);
  EXPECT_EQ(bob.eyes->refusals[1].id, 2);
  EXPECT_EQ(room->info().hash, hash);
  EXPECT_EQ(room->info().seq, 1u);
  EXPECT_EQ(meters->journal_failures[static_cast<std::size_t>(Code::disk_full)], 1u);
  EXPECT_EQ(meters->waiting_events, 0);
  check_folds(*this);
  settle(bob);
  for (const auto& [key, record] : chunks)
    EXPECT_EQ(bob.eyes->chunks.at(key).revision, record.revision);
  EXPECT_EQ(bob.eyes->chunks.size(), chunks.size());
  EXPECT_FALSE(ann.eyes->bye);
}

TEST_F(CommitTest, WhoLooksMeanwhileIsShownWhatComesBack) {
  for (int i = 0; i < 8; ++i) edit(ann, disc(20 + 8 * i, 4, 3));
  edit(ann, disc(4, 4, 2));
  commit_all();
  settle(bob);
  edit(ann, box(4, 4, 4, false));  // a chunk loses its mesh,
  Guest late = enter("late");
  ASSERT_TRUE(room->look(late.id, view_rect(1, {1, 1, 7, 7})));
  context.run();
  fail();  // and has it again
  settle(late);
  ASSERT_FALSE(late.eyes->parcels.empty());
  EXPECT_EQ(late.eyes->parcels.back().caught_up->seq, 9u);
  EXPECT_TRUE(late.eyes->chunks.contains({0, 0, 0, 0}));
  wait_out_the_pause();
  edit(ann, disc(5, 4, 2));  // another event 10
  commit();
  settle(late);
  settle(bob);
  EXPECT_EQ(late.eyes->chunks.at({0, 0, 0, 0}).revision, 10u);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
}

TEST_F(CommitTest, ForASecondEditsAreRefusedAndThenItTriesAgain) {
  edit(ann, disc(4, 4, 2));
  fail(Code::read_only);
  const auto refused = submit(ann, disc(9, 4, 2));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::read_only);
  context.advance(std::chrono::milliseconds(kPauseMs - 1));
  EXPECT_FALSE(submit(bob, disc(9, 4, 2)));
  EXPECT_EQ(clerk->waiting(), 0u);
  context.advance(1ms);
  edit(ann, disc(9, 4, 2));
  fail(Code::storage_failed);  // still no good
  EXPECT_EQ(submit(ann, disc(9, 4, 2)).error().code, Code::storage_failed);
  wait_out_the_pause();
  edit(ann, disc(9, 4, 2));
  commit();
  EXPECT_EQ(ann.eyes->acks.size(), 1u);
  EXPECT_EQ(ann.eyes->acks[0].seq, 1u);
  EXPECT_TRUE(submit(bob, disc(9, 4, 2)));
  commit_all();
  settle(bob);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
  check_folds(*this);
}

TEST_F(CommitTest, WhatWasDurableBeforeAFailureStays) {
  edit(ann, disc(4, 4, 2));
  edit(bob, disc(9, 4, 2));
  commit();  // ann's; bob's is in flight
  fail();
  EXPECT_EQ(ann.eyes->acks.size(), 1u);
  EXPECT_TRUE(ann.eyes->refusals.empty());
  EXPECT_TRUE(bob.eyes->acks.empty());
  EXPECT_EQ(bob.eyes->refusals.size(), 1u);
  EXPECT_EQ(events().size(), 1u);
  check_folds(*this);
}

TEST_F(CommitTest, AnIdThatWasTakenBackMayBeSentAgain) {
  const auto send = [&](protocol::MessageId id) {
    ASSERT_TRUE(room->submit(ann.id, {id, ann.author, disc(4.0 + static_cast<double>(id), 4, 2)}));
  };
  send(1), context.run(), commit();
  send(5), send(4), send(5), send(1), context.run();  // fresh, below it, repeated, durable
  fail();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {1, 1}}));
  ASSERT_EQ(ann.eyes->refusals.size(), 3u);
  for (const auto& refusal : ann.eyes->refusals) EXPECT_EQ(refusal.failure.code, Code::disk_full);
  wait_out_the_pause();
  send(4), send(5), context.run();
  commit_all();
  EXPECT_EQ(ann.eyes->acks.back(), (protocol::Applied{5, 3}));
  EXPECT_EQ(ann.eyes->refusals.size(), 3u);
  EXPECT_EQ(events().size(), 3u);
}

TEST_F(CommitTest, AnEditInPreparationIsRefusedToo) {
  protocol::Edit large = disc(0, 0, 20);  // 7 x 7 chunks each
  large.is_path = true;
  for (int i = 1; i < 1000; ++i) large.path.push_back({i / 16.0, 0});
  edit(ann, disc(300, 300, 2));
  ASSERT_TRUE(submit(bob, large));
  context.run(2);
  EXPECT_EQ(room->load().waiting_edits, 1u);
  fail();
  EXPECT_EQ(bob.eyes->refusals.size(), 1u);
  EXPECT_EQ(room->load().waiting_edits, 0u);
  wait_out_the_pause();
  ASSERT_TRUE(submit(bob, large));
  context.run();
  EXPECT_EQ(room->info().chunks, 0u);
  fail();  // when it was applied
  EXPECT_EQ(bob.eyes->refusals.size(), 2u);
  check_folds(*this);
  wait_out_the_pause();
  ASSERT_TRUE(submit(bob, large));
  commit_all();
  EXPECT_EQ(bob.eyes->acks.size(), 1u);
  check_folds(*this);
}

TEST_F(CommitTest, AFailureThatIsKnownAtOnceTakesNothingBackOfTheBatchBefore) {
  edit(ann, disc(4, 4, 3));
  edit(ann, disc(30, 4, 3));  // waits for the first
  store();
  clerk->at_once = true;  // so it fails within the call that hands it over
  fickle->trouble = protocol::Failure{Code::disk_full, "the disk is full", {}};
  context.run();
  EXPECT_EQ(ann.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
  ASSERT_EQ(ann.eyes->refusals.size(), 1u);
  settle(bob);
  EXPECT_FALSE(bob.eyes->chunks.empty());
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
  EXPECT_EQ(bob.eyes->parcels.at(0).group->seq, 1u);
  check_folds(*this);
}

TEST_F(CommitTest, NothingIsKeptInARoomThatHasClosed) {
  edit(ann, disc(4, 4, 2));
  fail(Code::damaged);
  ASSERT_TRUE(room->closed());
  std::vector<bool> told;  // the map still has the edit, and the journal has not
  room->once_durable([&](bool kept) { told.push_back(kept); });
  EXPECT_EQ(told, std::vector<bool>{false});
}

/// Somebody asks for figures all the time, and edits come all the time.
TEST_F(CommitTest, WhoAsksForTheNewestDoesNotKeepViewersWaiting) {
  std::uint64_t shown = 0;
  int last_shown = 0, answered = 0;
  const auto ask = [&] { answered += room->refresh_meshes(1000) ? 1 : 0; };
  for (int step = 1; step <= 40; ++step) {
    edit(ann, disc(4 + step, 4, 2)), ask();
    store();
    edit(ann, disc(4, 4 + step, 2)), ask();
    room->ready(bob.id);
    if (bob.eyes->parcels.empty()) continue;
    EXPECT_GT(bob.eyes->parcels.back().group->seq, shown);
    shown = bob.eyes->parcels.back().group->seq;
    bob.eyes->forget_parcels();
    EXPECT_LE(step - last_shown, 2);
    last_shown = step;
  }
  EXPECT_GE(last_shown, 39);
  EXPECT_GE(answered, 20);
}

TEST_F(CommitTest, AJournalThatIsAnotherClosesTheRoom) {
  for (const Code code : {Code::bad_state, Code::damaged, Code::internal}) {
    SlowWorld world;
    Guest eve = world.enter();
    world.edit(eve, disc(4, 4, 2));
    world.fail(code);
    ASSERT_TRUE(eve.eyes->bye);
    EXPECT_EQ(eve.eyes->bye->failure.code, code);
    EXPECT_EQ(eve.eyes->bye->retry_after_ms, 1000u);
    EXPECT_TRUE(eve.eyes->acks.empty());
    EXPECT_EQ(world.room->closed()->code, code);
    EXPECT_EQ(world.room->join(eve.eyes, {}).error().code, code);
  }
}

TEST(Retire, WaitsUntilNobodyIsThereAndNothingIsInFlight) {
  SlowWorld world;
  World::Guest ann = world.enter();
  bool closed = false;
  const auto retire = [&] { return world.room->retire([&] { closed = true; }); };
  EXPECT_FALSE(retire());
  world.edit(ann, disc(4, 4, 2));
  world.room->leave(ann.id);
  EXPECT_FALSE(retire());
  world.commit();
  ASSERT_TRUE(retire());
  EXPECT_FALSE(retire());
  EXPECT_EQ(world.room->join(ann.eyes, {}).error().code, Code::unavailable);
  EXPECT_FALSE(closed);
  for (int i = 0; i < 20 && !closed; ++i) {
    if (world.clerk->waiting() > 0) world.clerk->run(1);
    // The strand is what brings outcomes back, and what lets go of the clerk.
    if (world.clerk->waiting() == 0 && !world.journal->keyframes().value().empty() &&
        world.context.run(1) == 0)
      break;
    world.context.run(1);
  }
  EXPECT_TRUE(closed);
}

TEST(Retire, KnowsWhenTheRoomWasUsedLast) {
  World world;
  EXPECT_EQ(world.room->last_used_ms(), 0);
  world.context.advance(5s);
  World::Guest ann = world.enter();
  EXPECT_EQ(world.room->last_used_ms(), 5000);
  world.context.advance(1s);
  EXPECT_EQ(world.room->last_used_ms(), 5000);
  ASSERT_TRUE(world.submit(ann, disc(4, 4, 2)));
  EXPECT_EQ(world.room->last_used_ms(), 6000);
  world.context.advance(1s);
  (void)world.room->load();
  EXPECT_EQ(world.room->last_used_ms(), 6000);
  (void)world.room->info();
  EXPECT_EQ(world.room->last_used_ms(), 7000);
}

}  // namespace
}  // namespace earthwork::room
