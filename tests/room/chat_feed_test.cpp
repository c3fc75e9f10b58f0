// The chat feed: what was said before one came, then each new line, and no line twice.
#include "server/room/chat_feed.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "protocol/limits.hpp"

namespace earthwork::room {
namespace {

using Numbers = std::vector<std::uint64_t>;

struct ChatFeedTest : testing::Test {
  void say(const std::string& text = "hello") {
    feed.add({.time_ms = 1,
              .session = "0123456789abcdef",
              .name = "ann",
              .color = "#102030",
              .text = text});
    feed.advance();
  }
  std::vector<protocol::ChatLine> lines(ViewerId id) {
    const SharedText text = feed.news_for(id);
    if (!text) return {};
    return std::get<protocol::ChatLines>(protocol::parse_server_message(*text).value()).lines;
  }
  Numbers told(ViewerId id) {
    Numbers numbers;
    for (const auto& line : lines(id)) numbers.push_back(line.n);
    return numbers;
  }

  std::shared_ptr<ChatArchive> archive = std::make_shared<ChatArchive>();
  std::shared_ptr<ChatLog> log = std::make_shared<ChatLog>(archive);
  ChatFeed feed{log};
};

TEST_F(ChatFeedTest, TellsWhatWasSaidBeforeOneCame) {
  say("one"), say("two");
  feed.enter(1);
  const auto heard = lines(1);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].text, "one");
  EXPECT_EQ(heard[1].name, "ann");
  EXPECT_EQ(told(1), Numbers{});
  say("three");
  EXPECT_EQ(told(1), Numbers{3});
}

TEST_F(ChatFeedTest, WhereNothingWasSaidNothingIsTold) {
  feed.enter(1);
  EXPECT_EQ(feed.news_for(1), nullptr);
  EXPECT_EQ(feed.news_for(2), nullptr);  // nobody
  EXPECT_FALSE(feed.changed());
}

TEST_F(ChatFeedTest, ALineIsTheNewsOfTheNextAdvance) {
  feed.enter(1);
  feed.add({.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = "b"});
  EXPECT_TRUE(feed.changed());
  EXPECT_EQ(feed.news_for(1), nullptr);
  feed.enter(2);
  EXPECT_EQ(feed.news_for(2), nullptr);
  feed.advance();
  EXPECT_FALSE(feed.changed());
  feed.add({.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = "c"});
  const SharedText text = feed.news_for(1);
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("\"n\":1,"), std::string::npos);
  EXPECT_EQ(text->find("\"n\":2,"), std::string::npos);
}

TEST_F(ChatFeedTest, GoesOnInALogThatItFinds) {
  say("before"), say("before");
  ChatFeed next(log);
  next.enter(1);
  EXPECT_FALSE(next.changed());
  ASSERT_NE(next.news_for(1), nullptr);
  next.add({.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = "b"});
  next.advance();
  EXPECT_EQ(log->last(), 3u);
  EXPECT_NE(next.news_for(1), nullptr);
}

TEST_F(ChatFeedTest, ManyAreToldTheSameText) {
  for (ViewerId id = 1; id <= 1000; ++id) feed.enter(id);
  std::set<SharedText> texts;
  for (int n = 0; n < 3; ++n) {
    say();
    for (ViewerId id = 1; id <= 1000; ++id) texts.insert(feed.news_for(id));
  }
  EXPECT_EQ(texts.size(), 3u);
}

TEST_F(ChatFeedTest, WhoReadsSlowlyIsOwedWhatIsKeptAndInOrder) {
  feed.enter(1);
  say();
  EXPECT_EQ(told(1), Numbers{1});
  for (int i = 0; i < 250; ++i) say();
  const Numbers heard = told(1);
  ASSERT_EQ(heard.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(heard[i], 152 + i);
  EXPECT_EQ(told(1), Numbers{});
}

// A line of 500 characters of four bytes: 100 of them are 210 KB, and a message has 32 KiB.
TEST_F(ChatFeedTest, LongLinesComeInSeveralMessages) {
  std::string longest;
  for (int i = 0; i < 500; ++i) longest += "\xF0\x9F\x8C\x8D";
  for (int i = 0; i < 100; ++i) say(longest);
  feed.enter(1);
  Numbers all;
  int messages = 0;
  for (SharedText text = feed.news_for(1); text; text = feed.news_for(1), ++messages) {
    EXPECT_LE(text->size(), kMaxChatTextBytes);
    if (messages < 6) EXPECT_GT(text->size(), kMaxChatTextBytes - 2200);
    const auto message = protocol::parse_server_message(*text).value();
    for (const auto& line : std::get<protocol::ChatLines>(message).lines) all.push_back(line.n);
    if (messages == 20) break;
  }
  EXPECT_EQ(messages, 7);
  ASSERT_EQ(all.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(all[i], i + 1);
}

TEST_F(ChatFeedTest, ListenersAtManyPlacesAreEachToldTheirs) {
  for (ViewerId id = 1; id <= 60; ++id) feed.enter(id), say(), (void)feed.news_for(id);
  for (ViewerId id = 1; id <= 60; ++id) {
    const Numbers heard = told(id);
    EXPECT_EQ(heard.size(), 60 - id) << id;
    if (id < 60) {
      EXPECT_EQ(heard.front(), id + 1);
      EXPECT_EQ(heard.back(), 60u);
    }
  }
}

TEST_F(ChatFeedTest, WhoComesInIsToldTheSameTextHoweverManyReadSlowly) {
  for (ViewerId id = 1; id <= 30; ++id) feed.enter(id), say(), (void)feed.news_for(id);
  feed.enter(100), feed.enter(101);
  const SharedText first = feed.news_for(100);
  for (ViewerId id = 1; id < 30; ++id) (void)feed.news_for(id);
  EXPECT_EQ(feed.news_for(101), first);
}

TEST_F(ChatFeedTest, LinesThatOtherMapsTookThePlaceOfAreNotTold) {
  const auto small = std::make_shared<ChatArchive>(3000);
  const auto own = std::make_shared<ChatLog>(small);
  ChatFeed quiet(own);
  quiet.add({.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = "b"});
  quiet.advance();
  ChatLog loud(small);
  for (int i = 0; i < 10; ++i)
    loud.add(
        {.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = std::string(500, 'x')});
  quiet.enter(1);
  EXPECT_EQ(quiet.news_for(1), nullptr);
  quiet.add({.time_ms = 1, .session = {}, .name = "a", .color = {}, .text = "c"});
  quiet.advance();
  const SharedText text = quiet.news_for(1);
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("\"n\":2"), std::string::npos);
}

TEST_F(ChatFeedTest, WhoLeftIsToldNothing) {
  feed.enter(1), feed.enter(2);
  say();
  feed.leave(1);
  EXPECT_EQ(feed.news_for(1), nullptr);
  feed.leave_all();
  EXPECT_EQ(feed.news_for(2), nullptr);
  feed.enter(1);  // again
  EXPECT_EQ(told(1), Numbers{1});
}

}  // namespace
}  // namespace earthwork::room
