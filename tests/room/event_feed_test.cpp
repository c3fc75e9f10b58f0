// The feed of events: from where one likes, without a gap, and written once.
#include "server/room/event_feed.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <memory>
#include <string>

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
                      .edit = std::move(edit),
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

struct EventFeedTest : testing::Test {
  std::vector<SharedText> tell(ViewerId id, std::size_t bytes = kMaxTalkBytes) {
    std::vector<SharedText> out;
    feed.tell(id, events, bytes, out);
    return out;
  }
  std::vector<history::Event> events = some_events(5);
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
  events = some_events(7);
  EXPECT_EQ(seqs(tell(1)), (std::vector<std::uint64_t>{6, 7}));
}

TEST_F(EventFeedTest, MayBeFollowedFromTheNextEventOn) {
  feed.follow(1, 6);
  EXPECT_TRUE(tell(1).empty());
  events = some_events(6);
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
  feed.tell(1, events, size - 1, out);
  EXPECT_EQ(out.size(), 1u);  // after something else it may wait
  feed.tell(1, events, size, out);
  EXPECT_EQ(out.size(), 2u);
}

TEST_F(EventFeedTest, KeepsABoundedPartOfWhatItWrote) {
  events = some_events(100, 1000);  // 13 KB each
  feed.follow(1, 1), feed.follow(2, 1);
  std::vector<std::weak_ptr<const std::string>> kept;
  std::size_t told = 0;
  for (auto texts = tell(1); !texts.empty(); texts = tell(1))
    for (const SharedText& text : texts) told += text->size(), kept.push_back(text);
  ASSERT_EQ(kept.size(), 100u);
  ASSERT_GT(told, std::size_t{1} << 20);
  std::size_t held = 0;
  for (const auto& text : kept)
    if (const SharedText still = text.lock()) held += still->size();
  EXPECT_LE(held, std::size_t{1} << 20);
  EXPECT_FALSE(kept.back().expired());
  EXPECT_EQ(seqs(tell(2)).front(), 1u);  // what is not kept is written again
  feed.leave(1), feed.leave(2);
  EXPECT_TRUE(kept.back().expired());
}

/// Whenever and in whatever portions somebody listens, it gets every event once and in order.
TEST(EventFeed, HasNoGaps) {
  EXPECT_TRUE(rc::check([] {
    const auto all = some_events(40);
    std::size_t accepted = *rc::gen::inRange<std::size_t>(0, 41);
    EventFeed feed;
    const auto from = *rc::gen::inRange<std::uint64_t>(1, accepted + 2);
    feed.follow(1, from);
    std::vector<SharedText> heard;
    while (heard.size() + from <= all.size()) {
      std::vector<SharedText> out;
      feed.tell(1, std::span(all).first(accepted), *rc::gen::inRange<std::size_t>(0, 900), out);
      heard.insert(heard.end(), out.begin(), out.end());
      accepted = std::min(all.size(), accepted + *rc::gen::inRange<std::size_t>(1, 4));
    }
    const auto numbers = seqs(heard);
    for (std::size_t i = 0; i < numbers.size(); ++i) RC_ASSERT(numbers[i] == from + i);
    RC_ASSERT(from + numbers.size() == 41u);
  }));
}

}  // namespace
}  // namespace earthwork::room
