// Who is told what of its edits, and who leaves when.
#include "server/room/seats.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using protocol::Applied;
using protocol::Code;

struct SeatsTest : testing::Test {
  std::shared_ptr<Onlooker> enter(ViewerId id) {
    auto eyes = std::make_shared<Onlooker>();
    seats.enter(id, std::make_shared<GuardedViewer>(eyes, [] {}));
    return eyes;
  }
  void answer(ViewerId id, protocol::MessageId message, std::uint64_t seq) {
    seats.owe_answer(id);
    seats.answer(id, Applied{message, seq}, seq);
  }
  Seats seats;
};

TEST_F(SeatsTest, EachIsToldWhatIsDurableOfItsOwn) {
  const auto ann = enter(1), bob = enter(2);
  answer(1, 1, 5), answer(2, 1, 6), answer(1, 2, 7);
  seats.tell_answers(6);
  EXPECT_EQ(ann->acks, (std::vector<Applied>{{1, 5}}));
  EXPECT_EQ(bob->acks, (std::vector<Applied>{{1, 6}}));
  seats.tell_answers(7);
  EXPECT_EQ(ann->acks.size(), 2u);
}

TEST_F(SeatsTest, NothingHappensForNobody) {
  seats.owe_answer(9);
  seats.answer(9, Applied{1, 1}, 1);
  seats.tell_answers(1);
  EXPECT_FALSE(seats.leaves_when_told(9, [] {}));
  EXPECT_TRUE(seats.empty());
  EXPECT_TRUE(seats.take_leavers().empty());
}

TEST_F(SeatsTest, WhoIsOwedAnAnswerLeavesAfterIt) {
  const auto ann = enter(1);
  EXPECT_FALSE(seats.leaves_when_told(1, [] {}));  // owed nothing
  seats.owe_answer(1);
  answer(1, 2, 5);
  int gone = 0;
  EXPECT_TRUE(seats.leaves_when_told(1, [&] { ++gone; }));
  seats.tell_answers(5);
  EXPECT_TRUE(seats.take_leavers().empty());  // one is in line
  seats.answer(1, Applied{3, 6}, 6);
  EXPECT_TRUE(seats.take_leavers().empty());  // and is not durable
  seats.tell_answers(6);
  const auto leavers = seats.take_leavers();
  ASSERT_EQ(leavers.size(), 1u);
  EXPECT_EQ(leavers[0].id, 1u);
  leavers[0].gone();
  EXPECT_EQ(gone, 1);
  EXPECT_FALSE(seats.contains(1));
}

TEST_F(SeatsTest, WhatWillNotBeTrueIsRefusedToEverybody) {
  const auto ann = enter(1), bob = enter(2);
  answer(1, 1, 5), answer(1, 2, 6), answer(2, 1, 7);
  seats.refuse_answers(5, {Code::read_only, "no", {}});
  seats.tell_answers(5);
  EXPECT_EQ(ann->acks, (std::vector<Applied>{{1, 5}}));
  ASSERT_EQ(ann->refusals.size(), 1u);
  EXPECT_EQ(ann->refusals[0].id, 2);
  EXPECT_EQ(bob->refusals.at(0).failure.code, Code::read_only);
}

TEST_F(SeatsTest, WhoThrowsIsALeaverAtOnce) {
  struct Broken final : Viewer {
    void answered(std::vector<Reply>) override { throw std::runtime_error("broken"); }
    void deliver(Parcel) override {}
    void tell(Talk) override {}
    void settings(SharedText) override {}
    void end(protocol::Bye) override {}
  };
  int broke = 0;
  seats.enter(3, std::make_shared<GuardedViewer>(std::make_shared<Broken>(), [&] { ++broke; }));
  answer(3, 1, 1);
  seats.owe_answer(3);
  seats.tell_answers(1);
  EXPECT_EQ(broke, 1);
  EXPECT_EQ(seats.take_leavers().size(), 1u);
  EXPECT_TRUE(seats.empty());
}

TEST_F(SeatsTest, AtTheEndEverybodyIsToldAndGone) {
  const auto ann = enter(1), bob = enter(2);
  answer(1, 1, 5);
  seats.end({.failure = {Code::unknown_map, "deleted", "map"}, .retry_after_ms = {}});
  EXPECT_TRUE(ann->bye && bob->bye);
  EXPECT_TRUE(ann->acks.empty());
  EXPECT_TRUE(seats.empty());
}

}  // namespace
}  // namespace earthwork::room
