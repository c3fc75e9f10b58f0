// The feed of events: from where one likes, without a gap, and written once.
#include "server/room/event_feed.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <memory>
#include <string>

#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"
#include "tests/room/manual_clerk.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

std::vector<history::Event> some_events(std::uint64_t count, std::size_t points = 1) {
  std::vector<history::Event> events;
  for (std::uint64_t seq = 1; seq <= count; ++seq) {
    protocol::Edit edit = disc(static_cast<double>(seq), 2, 1);
    edit.path.resize(points, {0.5, 0.25});
    edit.is_path = points > 1;
    events.push_back({.seq = seq,
                      .time_ms = 1'700'000'000'000,
                      .author = 0xAB,
                      .id = 4,
                      .action = std::move(edit),
                      .hash = 0x8A9A5B});
  }
  return events;
}

std::vector<std::uint64_t> seqs(const std::vector<SharedText>& texts) {
  std::vector<std::uint64_t> seqs;
  for (const SharedText& text : texts)
    seqs.push_back(std::get<protocol::Event>(protocol::parse_server_message(*text).value()).seq);
  return seqs;
}

/// Five events happened here, and nothing has to be read.
struct EventFeedTest : testing::Test {
  EventFeedTest() { happen(5); }
  void happen(std::uint64_t count, std::size_t points = 1) {
    const auto all = some_events(past.last_seq() + count, points);
    past.add(std::span(all).subspan(past.last_seq()));
  }
  std::vector<SharedText> tell(ViewerId id, std::size_t bytes = kMaxTalkBytes) {
    std::vector<SharedText> out;
    feed.tell(id, past, bytes, out);
    return out;
  }
  ManualClerk clerk{journal::make_memory_journal(journal::small_identity())};
  PastEvents past{clerk, back_at_once, 0};
  EventFeed feed;
};

/// 2,000 events lie in the journal, which a test may tamper with.
struct EventFeedOfThePast : testing::Test {
  EventFeedOfThePast() {
    auto journal = journal::make_memory_journal(journal::small_identity());
    EXPECT_TRUE(journal->append(0, some_events(2000)));
    auto tampered = std::make_unique<journal::TamperedJournal>(std::move(journal));
    log = tampered.get();
    clerk = std::make_unique<ManualClerk>(std::move(tampered));
    past = std::make_unique<PastEvents>(*clerk, back_at_once, 2000);
  }
  std::vector<SharedText> tell(ViewerId id) {
    std::vector<SharedText> out;
    feed.tell(id, *past, kMaxTalkBytes, out);
    return out;
  }
  journal::TamperedJournal* log = nullptr;
  std::unique_ptr<ManualClerk> clerk;
  std::unique_ptr<PastEvents> past;
  EventFeed feed;
};

TEST_F(EventFeedTest, WritesAnEventAsTheProtocolHasIt) {
  feed.follow(1, 5);
  const auto texts = tell(1);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(*texts[0],
            R"({"type":"event","seq":5,"time":1700000000000,"author":"00000000000000ab",)"
            R"("kind":"edit","stencil":"circle","fill":true,"x":5.0,"y":2.0,"radius":1.0,)"
            R"("hash":"00000000008a9a5b"})");
}

TEST_F(EventFeedTest, TellsThePastAndThenWhatComes) {
  feed.follow(1, 3);
  EXPECT_EQ(seqs(tell(1)), (std::vector<std::uint64_t>{3, 4, 5}));
  EXPECT_TRUE(tell(1).empty());
  happen(2);
  EXPECT_EQ(seqs(tell(1)), (std::vector<std::uint64_t>{6, 7}));
}

TEST_F(EventFeedTest, MayBeFollowedFromTheNextEventOn) {
  feed.follow(1, 6);
  EXPECT_TRUE(tell(1).empty());
  happen(1);
  EXPECT_EQ(seqs(tell(1)), (std::vector<std::uint64_t>{6}));
}

TEST_F(EventFeedTest, StartsAnewWhenAskedAgain) {
  feed.follow(1, 3);
  (void)tell(1);
  feed.follow(1, 2);
  EXPECT_EQ(seqs(tell(1)), (std::vector<std::uint64_t>{2, 3, 4, 5}));
}

TEST_F(EventFeedTest, TellsNothingToWhoDoesNotFollow) {
  EXPECT_TRUE(tell(1).empty());
  feed.follow(1, 1);
  EXPECT_EQ(feed.followers().size(), 1u);
  feed.leave(1);
  EXPECT_TRUE(tell(1).empty());
  EXPECT_TRUE(feed.empty());
  EXPECT_TRUE(feed.followers().empty());
}

TEST_F(EventFeedTest, WritesAnEventOnceForAll) {
  feed.follow(1, 1), feed.follow(2, 4);
  const auto first = tell(1), second = tell(2);
  EXPECT_EQ(first[3].get(), second[0].get());
  EXPECT_EQ(first[4].get(), second[1].get());
}

TEST_F(EventFeedTest, TellsAsMuchAsThereIsRoomFor) {
  feed.follow(1, 1);
  const std::size_t size = tell(1).front()->size();
  feed.follow(1, 1);
  EXPECT_EQ(tell(1, 2 * size).size(), 2u);
  EXPECT_EQ(tell(1, 2 * size - 1).size(), 1u);
  EXPECT_EQ(tell(1, 1).size(), 1u);  // one at least
  std::vector<SharedText> out{std::make_shared<const std::string>("presence")};
  feed.tell(1, past, size - 1, out);
  EXPECT_EQ(out.size(), 1u);  // after something else it may wait
  feed.tell(1, past, size, out);
  EXPECT_EQ(out.size(), 2u);
}

TEST_F(EventFeedTest, KeepsABoundedPartOfWhatItWrote) {
  auto journal = journal::make_memory_journal(journal::small_identity());
  ASSERT_TRUE(journal->append(0, some_events(100, 1000)));  // 13 KB each
  const auto immediate = journal::immediate_clerk(std::move(journal));
  PastEvents long_past(*immediate, back_at_once, 100);
  const auto tell_of_it = [&](ViewerId id) {
    std::vector<SharedText> out;
    feed.tell(id, long_past, kMaxTalkBytes, out);
    return out;
  };
  feed.follow(1, 1), feed.follow(2, 1);
  std::vector<std::weak_ptr<const std::string>> kept;
  std::size_t told = 0;
  for (auto texts = tell_of_it(1); !texts.empty(); texts = tell_of_it(1))
    for (const SharedText& text : texts) told += text->size(), kept.push_back(text);
  ASSERT_EQ(kept.size(), 100u);
  ASSERT_GT(told, std::size_t{1} << 20);
  std::size_t held = 0;
  for (const auto& text : kept)
    if (const SharedText still = text.lock()) held += still->size();
  EXPECT_LE(held, std::size_t{1} << 20);
  EXPECT_FALSE(kept.back().expired());
  EXPECT_EQ(seqs(tell_of_it(2)).front(), 1u);  // what is not kept is written again
  feed.leave(1), feed.leave(2);
  EXPECT_TRUE(kept.back().expired());
}

TEST_F(EventFeedOfThePast, WaitsForAPage) {
  feed.follow(1, 100);
  EXPECT_TRUE(tell(1).empty());
  clerk->run();
  const auto told = seqs(tell(1));
  ASSERT_GT(told.size(), 50u);
  EXPECT_EQ(told.front(), 100u);
  EXPECT_EQ(told.back(), 99 + told.size());
}

TEST_F(EventFeedOfThePast, SaysWhereTheEventsEndThatCannotBeRead) {
  log->unreadable_event = 110;
  feed.follow(1, 100), feed.follow(2, 200);
  past->when_page_comes([&] {
    const auto told = tell(1);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(*told[0],
              R"({"type":"rejected","code":"damaged","message":"from_seq: the events from 100 on )"
              R"(cannot be read","field":"from_seq"})");
  });
  EXPECT_TRUE(tell(1).empty());
  clerk->run();
  past->when_page_comes([] {});
  EXPECT_EQ(feed.followers(), std::vector<ViewerId>{2});
  EXPECT_TRUE(tell(1).empty());
  EXPECT_TRUE(tell(2).empty());  // has nothing to do with it
  clerk->run();
  EXPECT_EQ(seqs(tell(2)).front(), 200u);
}

TEST_F(EventFeedOfThePast, WhoReadsThePastGetsAPageInTurn) {
  for (ViewerId id = 1; id <= 3; ++id) feed.follow(id, 500 * id);
  std::vector<std::uint64_t> read;
  for (int n = 0; n < 6; ++n) {
    for (const ViewerId id : feed.followers()) (void)tell(id);
    read.push_back(past->reading().value_or(0));
    clerk->run();
  }
  // The first page of each, and only then the next ones.
  EXPECT_EQ(read[0], 500u);
  EXPECT_EQ(read[1], 1000u);
  EXPECT_EQ(read[2], 1500u);
  EXPECT_TRUE(500 < read[3] && read[3] < 1000) << read[3];
  EXPECT_TRUE(1000 < read[4] && read[4] < 1500) << read[4];
  EXPECT_TRUE(1500 < read[5]) << read[5];
}

/// Whenever and in whatever portions somebody listens, it gets every event once and in order.
TEST(EventFeed, HasNoGaps) {
  EXPECT_TRUE(rc::check([] {
    const auto all = some_events(40);
    const auto start = *rc::gen::inRange<std::size_t>(0, 41);  // before it lies in the journal
    auto journal = journal::make_memory_journal(journal::small_identity());
    if (start > 0) RC_ASSERT(journal->append(0, std::span(all).first(start)).has_value());
    ManualClerk clerk(std::move(journal));
    PastEvents past(clerk, back_at_once, start);
    EventFeed feed;
    const auto from = *rc::gen::inRange<std::uint64_t>(1, start + 2);
    feed.follow(1, from);
    std::vector<SharedText> heard;
    while (heard.size() + from <= all.size()) {
      std::vector<SharedText> out;
      feed.tell(1, past, *rc::gen::inRange<std::size_t>(0, 900), out);
      heard.insert(heard.end(), out.begin(), out.end());
      const auto more =
          std::min(all.size() - past.last_seq(), *rc::gen::inRange<std::size_t>(1, 4));
      past.add(std::span(all).subspan(past.last_seq(), more));
      clerk.run(1);
    }
    const auto numbers = seqs(heard);
    for (std::size_t i = 0; i < numbers.size(); ++i) RC_ASSERT(numbers[i] == from + i);
    RC_ASSERT(from + numbers.size() == 41u);
  }));
}

}  // namespace
}  // namespace earthwork::room
