// What gathers, what goes together, and what is known of it when.
#include "server/room/ledger.hpp"

#include <gtest/gtest.h>

#include <future>

#include "tests/room/fickle_journal.hpp"
#include "tests/room/manual_clerk.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

constexpr std::int64_t kNow = 50'000;

struct LedgerTest : testing::Test {
  void accept(int count) {
    for (; count > 0; --count) {
      history::Event event;
      event.seq = ledger->accepted_seq() + 1;
      event.hash = 100 + event.seq;
      ledger->accept(std::move(event));
    }
  }
  bool hand_over() {
    return ledger->hand_over(ledger->accepted_seq(), [this] { ++ended; });
  }
  void fail_append(Code code) {
    journal->trouble = protocol::Failure{code, "no", {}};
    clerk.run();
    journal->trouble.reset();
  }

  FickleJournal* journal = new FickleJournal({});
  ManualClerk clerk{std::unique_ptr<journal::Journal>(journal)};
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
  std::unique_ptr<Ledger> ledger = std::make_unique<Ledger>(clerk, Milestone{}, meters);
  int ended = 0;
};

TEST_F(LedgerTest, WhatGathersMeanwhileIsTheNextBatch) {
  EXPECT_TRUE(ledger->idle());
  EXPECT_FALSE(ledger->can_hand_over());
  accept(1);
  EXPECT_FALSE(ledger->idle());
  ASSERT_TRUE(ledger->can_hand_over());
  EXPECT_FALSE(hand_over());
  accept(2);
  EXPECT_FALSE(ledger->can_hand_over());
  EXPECT_EQ(ledger->durable(), Milestone{});
  EXPECT_EQ(ledger->accepted_seq(), 3u);

  clerk.run();
  EXPECT_EQ(ended, 1);
  const auto first = ledger->settle(kNow).value();
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].seq, 1u);
  EXPECT_EQ(ledger->durable(), (Milestone{1, 101, 1}));
  EXPECT_FALSE(hand_over());
  clerk.run();
  EXPECT_EQ(ledger->settle(kNow).value().size(), 2u);
  EXPECT_EQ(ledger->durable(), (Milestone{3, 103, 3}));
  EXPECT_TRUE(ledger->idle());
  EXPECT_EQ(journal->batches, (std::vector<std::size_t>{1, 2}));
}

TEST_F(LedgerTest, GoesOnFromWhereTheJournalEnds) {
  accept(2);
  EXPECT_FALSE(hand_over());
  clerk.run();
  ASSERT_TRUE(ledger->settle(kNow));
  ledger = std::make_unique<Ledger>(clerk, Milestone{2, 102, 7}, meters);
  EXPECT_EQ(ledger->durable(), (Milestone{2, 102, 7}));
  accept(1);
  EXPECT_FALSE(hand_over());
  clerk.run();
  EXPECT_EQ(ledger->settle(kNow).value().at(0).seq, 3u);
}

TEST_F(LedgerTest, AFailureTakesEverythingBackThatIsNotDurable) {
  accept(1);
  EXPECT_FALSE(hand_over());
  accept(2);
  fail_append(Code::disk_full);
  const auto events = ledger->settle(kNow);
  ASSERT_FALSE(events);
  EXPECT_EQ(events.error().code, Code::disk_full);
  EXPECT_TRUE(ledger->idle());
  EXPECT_EQ(ledger->accepted_seq(), 0u);
  EXPECT_EQ(meters->waiting_events, 0);
  EXPECT_EQ(meters->journal_failures[static_cast<std::size_t>(Code::disk_full)], 1u);

  accept(1);
  EXPECT_FALSE(hand_over());
  clerk.run();
  EXPECT_EQ(ledger->settle(kNow).value().size(), 1u);
  EXPECT_EQ(journal->last_seq(), 1u);
}

TEST_F(LedgerTest, TroubleLastsASecond) {
  EXPECT_EQ(ledger->trouble(kNow), nullptr);
  accept(1);
  EXPECT_FALSE(hand_over());
  fail_append(Code::read_only);
  EXPECT_FALSE(ledger->settle(kNow));
  ASSERT_NE(ledger->trouble(kNow), nullptr);
  EXPECT_EQ(ledger->trouble(kNow)->code, Code::read_only);
  EXPECT_NE(ledger->trouble(kNow + 999), nullptr);
  EXPECT_EQ(ledger->trouble(kNow + 1000), nullptr);
  EXPECT_EQ(ledger->trouble(kNow - 1), nullptr);  // a clock that was set back
}

TEST_F(LedgerTest, IsFullAtItsMostEvents) {
  accept(4095);
  EXPECT_FALSE(ledger->full());
  accept(1);
  EXPECT_TRUE(ledger->full());
  EXPECT_FALSE(hand_over());
  EXPECT_FALSE(ledger->full());
}

TEST_F(LedgerTest, IsFullAtItsMostBytes) {
  for (int i = 1; !ledger->full(); ++i) {
    ASSERT_LE(i, 512);
    history::Event event;
    event.seq = ledger->accepted_seq() + 1;
    std::get<protocol::Edit>(event.action).path.assign(1024, {0, 0});
    ledger->accept(std::move(event));
  }
  EXPECT_GE(ledger->accepted_seq(), 480u);  // 8 MiB of 16 KiB each, and a little more
  EXPECT_FALSE(hand_over());
  EXPECT_FALSE(ledger->full());
}

TEST_F(LedgerTest, AnAppendThatEndsWithinTheCallIsKnownOfThen) {
  const auto immediate = journal::immediate_clerk(journal::make_memory_journal({}));
  ledger = std::make_unique<Ledger>(*immediate, Milestone{}, meters);
  accept(3);
  EXPECT_TRUE(hand_over());
  EXPECT_EQ(ledger->settle(kNow).value().size(), 3u);
  EXPECT_EQ(ended, 0);
  EXPECT_EQ(meters->commits, 1u);
  EXPECT_EQ(meters->committed_events, 3u);
}

TEST_F(LedgerTest, OneThatEndsOnAThreadOfItsOwnIsKnownOfOnce) {
  const auto hired = journal::hire_clerk(journal::make_memory_journal({}));
  ledger = std::make_unique<Ledger>(*hired, Milestone{}, meters);
  for (int i = 1; i <= 200; ++i) {
    accept(1);
    std::promise<void> later;
    std::future<void> told = later.get_future();
    const bool within = ledger->hand_over(0, [&later] { later.set_value(); });
    if (!within) told.wait();
    ASSERT_EQ(ledger->settle(kNow).value().size(), 1u);
  }
  EXPECT_EQ(ledger->durable().seq, 200u);
}

TEST_F(LedgerTest, TellsWaitersInOrderAndOnlyOfWhatTheyWaitFor) {
  std::vector<int> told;
  const auto wait = [&](int who) {
    ledger->once_durable([&told, who](bool kept) { told.push_back(kept ? who : -who); });
  };
  wait(1);
  EXPECT_EQ(told, std::vector<int>{1});
  accept(1), wait(2);
  EXPECT_FALSE(hand_over());
  accept(1), wait(3), wait(4);
  ledger->tell_waiters();
  EXPECT_EQ(told.size(), 1u);
  clerk.run();
  ASSERT_TRUE(ledger->settle(kNow));
  ledger->tell_waiters();
  EXPECT_EQ(told, (std::vector<int>{1, 2}));
  EXPECT_FALSE(hand_over());
  accept(1), wait(5);
  fail_append(Code::disk_full);
  EXPECT_FALSE(ledger->settle(kNow));
  accept(1), wait(6);
  ledger->tell_waiters();
  EXPECT_EQ(told, (std::vector<int>{1, 2, -3, -4, -5}));
  ledger->give_up();
  EXPECT_EQ(told.back(), -6);
}

TEST_F(LedgerTest, CountsWhatWaitsUntilItsEnd) {
  accept(2);
  EXPECT_FALSE(hand_over());
  accept(1);
  EXPECT_EQ(meters->waiting_events, 3);
  ledger.reset();
  EXPECT_EQ(meters->waiting_events, 0);
  clerk.run();  // what is on its way gets there all the same
  EXPECT_EQ(journal->last_seq(), 2u);
  EXPECT_EQ(ended, 1);
}

}  // namespace
}  // namespace earthwork::room
