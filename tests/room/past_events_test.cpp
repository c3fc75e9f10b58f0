// Events of the past: the latest at hand, older ones a page at a time, and no more in memory than
// a few pages however long the log is.
#include "server/room/past_events.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <memory>
#include <new>
#include <optional>
#include <vector>

#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"
#include "tests/room/manual_clerk.hpp"

namespace earthwork::room {
namespace {

using history::Event;
using journal::TamperedJournal;

std::vector<Event> numbered(std::uint64_t from, std::uint64_t to, std::size_t points = 1) {
  std::vector<Event> events;
  for (std::uint64_t seq = from; seq <= to; ++seq) {
    Event event{.seq = seq, .time_ms = 0, .author = 7, .id = 1, .action = {}, .hash = seq * 3};
    std::get<protocol::Edit>(event.action).path.resize(points);
    events.push_back(std::move(event));
  }
  return events;
}

struct PastEventsTest : testing::Test {
  /// A journal of so many events, which nobody has read yet.
  explicit PastEventsTest(std::uint64_t count = 1000) {
    auto journal = journal::make_memory_journal(journal::small_identity());
    EXPECT_TRUE(journal->append(0, numbered(1, count)));
    auto tampered = std::make_unique<TamperedJournal>(std::move(journal));
    log = tampered.get();
    clerk = std::make_unique<ManualClerk>(std::move(tampered));
    past = std::make_unique<PastEvents>(*clerk, back_at_once, count);
    past->when_page_comes([this] { ++came; });
  }
  /// Of the event at hand; 0 when it is not.
  std::uint64_t seq_at(std::uint64_t seq) {
    const auto found = past->find(seq);
    return found && *found ? (*found)->seq : 0;
  }
  TamperedJournal* log = nullptr;
  std::unique_ptr<ManualClerk> clerk;
  std::unique_ptr<PastEvents> past;
  int came = 0;
};

TEST_F(PastEventsTest, TheLatestAreAtHand) {
  past->add(numbered(1001, 1003));
  EXPECT_EQ(past->last_seq(), 1003u);
  EXPECT_EQ(seq_at(1001), 1001u);
  EXPECT_EQ(seq_at(1003), 1003u);
  EXPECT_EQ((*past->find(1003))->hash, 3009u);
  EXPECT_EQ(clerk->waiting(), 0u);
}

TEST_F(PastEventsTest, OlderOnesComeInAPage) {
  EXPECT_EQ(seq_at(5), 0u);
  EXPECT_EQ(past->reading(), 5u);
  EXPECT_EQ(clerk->waiting_idle(), 1u);  // a commit comes first
  EXPECT_EQ(came, 0);
  clerk->run();
  EXPECT_EQ(came, 1);
  EXPECT_FALSE(past->reading());
  EXPECT_EQ(seq_at(5), 5u);
  EXPECT_EQ(seq_at(50), 50u);
  EXPECT_EQ(clerk->waiting(), 0u);
  EXPECT_EQ(seq_at(4), 0u);    // the page begins with what was asked for,
  EXPECT_EQ(seq_at(900), 0u);  // and is far from holding all
}

TEST_F(PastEventsTest, OnePageIsReadAtATime) {
  for (std::uint64_t seq = 1; seq <= 1000; ++seq) EXPECT_EQ(seq_at(seq), 0u);
  EXPECT_EQ(clerk->waiting(), 1u);
  clerk->run();
  EXPECT_EQ(seq_at(1), 1u);
  EXPECT_EQ(seq_at(1000), 0u);
  EXPECT_EQ(past->reading(), 1000u);
}

TEST_F(PastEventsTest, AClerkThatWorksAtOnceHasThePageAtOnce) {
  const auto immediate = journal::immediate_clerk(journal::journal_of(journal::ten_events()));
  PastEvents at_once(*immediate, back_at_once, 10);
  at_once.when_page_comes([&] { ++came; });
  ASSERT_TRUE(at_once.find(4));
  EXPECT_EQ((*at_once.find(4))->seq, 4u);
  EXPECT_EQ(came, 0);  // who asked has it
}

TEST_F(PastEventsTest, WhatIsNotDurableYetIsNotInAPage) {
  PastEvents behind(*clerk, back_at_once, 20);
  (void)behind.find(15);
  clerk->run();
  EXPECT_EQ((*behind.find(20))->seq, 20u);
  behind.add(numbered(21, 21 + kWindowEvents));  // 21 itself is too many
  ASSERT_TRUE(behind.find(21));
  EXPECT_EQ(*behind.find(21), nullptr);
}

TEST_F(PastEventsTest, TheWindowIsBoundedByEventsAndByMemory) {
  past->add(numbered(1001, 6000));
  EXPECT_EQ(seq_at(6000 - kWindowEvents + 1), 6000 - kWindowEvents + 1);
  EXPECT_EQ(seq_at(6000 - kWindowEvents), 0u);
  past->add(numbered(6001, 6400, 1000));  // 16 KB each
  EXPECT_EQ(seq_at(6400), 6400u);
  EXPECT_EQ(seq_at(6340), 6340u);
  EXPECT_EQ(seq_at(6400 - kWindowBytes / 16000), 0u);
}

TEST_F(PastEventsTest, AFewPagesAreKept) {
  // Backwards, each page begins before the last one and is a new one.
  const auto start = [](std::size_t n) { return 500 - n; };
  for (std::size_t n = 0; n <= kKeptPages; ++n) (void)past->find(start(n)), clerk->run();
  EXPECT_EQ(seq_at(start(kKeptPages)), start(kKeptPages));
  std::uint64_t last = 500;  // of the pages that are kept
  while (seq_at(last + 1) != 0) ++last;
  clerk->run();
  past->forget_pages();
  (void)past->find(500), clerk->run();
  std::uint64_t last_of_first = 500;
  while (seq_at(last_of_first + 1) != 0) ++last_of_first;
  EXPECT_EQ(last + 1, last_of_first);  // the first one had been let go of
}

TEST_F(PastEventsTest, ThePageThatIsReadStays) {
  (void)past->find(100), clerk->run();
  std::uint64_t others = 900;  // backwards, so that each is a new page
  for (std::size_t n = 0; n < 2 * kKeptPages; ++n) {
    EXPECT_EQ(seq_at(100), 100u) << n;
    (void)past->find(--others), clerk->run();
  }
}

TEST_F(PastEventsTest, AFailureIsToldOnceForEveryAttempt) {
  log->unreadable_event = 300;
  EXPECT_EQ(seq_at(300), 0u);
  int failures = 0;
  past->when_page_comes([&] {
    const auto found = past->find(300);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, protocol::Code::damaged);
    ++failures;
  });
  clerk->run();
  EXPECT_EQ(failures, 1);
  log->unreadable_event.reset();
  EXPECT_EQ(seq_at(300), 0u);  // who asks again has it tried again
  past->when_page_comes([] {});
  clerk->run();
  EXPECT_EQ(seq_at(300), 300u);
}

TEST_F(PastEventsTest, AJournalThatThrowsHasFailed) {
  log->change_event = [](Event&) { throw std::bad_alloc(); };
  EXPECT_EQ(seq_at(300), 0u);
  std::optional<protocol::Code> code;
  past->when_page_comes([&] { code = past->find(300).error().code; });
  clerk->run();
  EXPECT_EQ(code, protocol::Code::internal);
}

TEST_F(PastEventsTest, AFailureThatNobodyAsksForIsForgotten) {
  log->unreadable_event = 300;
  (void)past->find(300);
  clerk->run();
  log->unreadable_event.reset();
  EXPECT_TRUE(past->find(300));
  clerk->run();
  EXPECT_EQ(seq_at(300), 300u);
}

TEST_F(PastEventsTest, AClerkThatWorksAtOnceTellsAFailureAtOnce) {
  auto tampered = std::make_unique<TamperedJournal>(journal::journal_of(journal::ten_events()));
  tampered->unreadable_event = 4;
  const auto immediate = journal::immediate_clerk(std::move(tampered));
  PastEvents at_once(*immediate, back_at_once, 10);
  EXPECT_FALSE(at_once.find(4));
  EXPECT_FALSE(at_once.find(2));  // of the page, and not a later asker's
  EXPECT_TRUE(at_once.find(5));
}

TEST_F(PastEventsTest, APageThatIsNotWhatItShouldBeIsDamaged) {
  protocol::Code code = protocol::Code::internal;
  past->when_page_comes([&] {
    const auto found = past->find(10);
    if (!found) code = found.error().code;
  });
  log->change_event = [](Event& event) { event.seq += event.seq == 12; };
  (void)past->find(10);
  clerk->run();
  EXPECT_EQ(code, protocol::Code::damaged);

  code = protocol::Code::internal;
  PastEvents beyond(*clerk, back_at_once, 2000);  // the journal has half of them
  beyond.when_page_comes([&] {
    const auto found = beyond.find(1500);
    if (!found) code = found.error().code;
  });
  (void)beyond.find(1500);
  clerk->run();
  EXPECT_EQ(code, protocol::Code::damaged);
}

TEST_F(PastEventsTest, APageForARoomThatIsGoneIsDropped) {
  auto alive = std::make_shared<int>(1);
  const auto back = [weak = std::weak_ptr<int>(alive)](const Strand::Task& task) {
    if (weak.lock()) task();
  };
  auto gone = std::make_unique<PastEvents>(
      *clerk, [&] { return Workplace{.aside = {}, .back = back}; }, 1000);
  (void)gone->find(1);
  gone.reset();
  alive.reset();
  EXPECT_EQ(clerk->run(), 1);
}

/// Whoever goes through all of it, however it grows meanwhile, gets every event once; and what a
/// page brings is bounded.
TEST(PastEvents, AreAllThere) {
  EXPECT_TRUE(rc::check([] {
    const auto points = *rc::gen::elementOf(std::vector<std::size_t>{1, 30, 900});
    const auto stored = *rc::gen::inRange<std::uint64_t>(0, 400);
    const auto all = numbered(1, stored + 300, points);
    auto journal = journal::make_memory_journal(journal::small_identity());
    if (stored > 0) RC_ASSERT(journal->append(0, std::span(all).first(stored)).has_value());
    ManualClerk clerk(std::move(journal));
    PastEvents past(clerk, back_at_once, stored);
    std::uint64_t next = 1;
    for (int rounds = 0; next <= all.size(); ++rounds) {
      const bool last = rounds > 50;
      const auto more = std::min<std::uint64_t>(
          last ? 700 : *rc::gen::inRange<std::uint64_t>(0, 60), all.size() - past.last_seq());
      if (more > 0) {
        const auto batch = std::span(all).subspan(past.last_seq(), more);
        RC_ASSERT(clerk.journal().append(past.last_seq(), batch).has_value());
        past.add(batch);
      }
      int steps = last ? 1000 : *rc::gen::inRange(1, 80);
      for (; steps > 0 && next <= past.last_seq(); --steps) {
        const auto found = past.find(next);
        RC_ASSERT(found.has_value());
        if (!*found) break;
        RC_ASSERT((*found)->hash == 3 * next);
        ++next;
      }
      clerk.run(last ? 1 : *rc::gen::inRange(0, 2));
    }
  }));
}

}  // namespace
}  // namespace earthwork::room
