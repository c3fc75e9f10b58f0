// Who is there, what was said and what went wrong: kept as it is told, and bounded.
#include "client/viewer/people.hpp"

#include <gtest/gtest.h>

#include "client/viewer/chat_log.hpp"
#include "client/viewer/cursor_teller.hpp"
#include "client/viewer/notices.hpp"
#include "protocol/limits.hpp"
#include "tests/viewer/played_server.hpp"

namespace earthwork::viewer {
namespace {

using namespace std::chrono_literals;

const Notices::Time kStart{};

protocol::UserCursor pointing(const std::string& session, double x) {
  return {.session = session,
          .at = protocol::MapPoint{x, 0},
          .brush = protocol::Brush{},
          .view = protocol::MapRect{0, 0, 1, 1}};
}

std::vector<std::string> names(const People& people) {
  std::vector<std::string> out;
  for (const auto& person : people.part({}).people) out.push_back(person.name);
  return out;
}

TEST(People, ListsOneselfFirstAndOthersByTheirNames) {
  People people;
  people.join({user(kBob, "Bob"), user(kMe, "Me"), user(kAnn, "Ann")}, kMe);
  EXPECT_EQ(names(people), (std::vector<std::string>{"Me", "Ann", "Bob"}));
  EXPECT_TRUE(people.part(kBob).people[0].me);
  EXPECT_TRUE(people.part(kBob).people[2].followed);
}

TEST(People, FollowsWhoComesLeavesAndPoints) {
  People people;
  people.join({user(kMe, "Me")}, kMe);
  people.take({.all = false, .users = {user(kAnn, "Ann")}, .left = {}, .cursors = {}});
  people.take({.all = false,
               .users = {},
               .left = {},
               .cursors = {pointing(kAnn, 5), pointing(kBob, 1)}});  // of nobody who is there
  ASSERT_TRUE(people.find(kAnn));
  EXPECT_EQ(people.find(kAnn)->cursor, (protocol::MapPoint{5, 0}));
  EXPECT_TRUE(people.part({}).people[1].has_view);
  EXPECT_FALSE(people.find(kBob));
  people.take({.all = false, .users = {}, .left = {}, .cursors = {{kAnn, {}, {}, {}}}});
  EXPECT_FALSE(people.find(kAnn)->cursor);
  people.take({.all = false, .users = {}, .left = {kAnn}, .cursors = {}});
  EXPECT_EQ(names(people), std::vector<std::string>{"Me"});
}

TEST(People, OfAListOfAllOnlyThoseStay) {
  People people;
  people.join({user(kMe, "Me"), user(kAnn, "Ann"), user(kBob, "Bob")}, kMe);
  people.take({.all = false, .users = {}, .left = {}, .cursors = {pointing(kAnn, 1)}});
  people.take(
      {.all = true, .users = {user(kMe, "Me"), user(kAnn, "Ann")}, .left = {}, .cursors = {}});
  EXPECT_EQ(names(people), (std::vector<std::string>{"Me", "Ann"}));
  EXPECT_FALSE(people.find(kAnn)->cursor);
}

TEST(People, AreNotKeptWithoutBound) {
  People people;
  people.join({}, kMe);
  for (std::uint64_t i = 0; i < kMaxPeople + 10; ++i)
    people.take({.all = false, .users = {user(protocol::hex(i), "x")}, .left = {}, .cursors = {}});
  EXPECT_EQ(people.persons().size(), kMaxPeople);
}

TEST(ChatLog, KeepsTheLastHundredLines) {
  ChatLog chat;
  for (std::uint64_t n = 1; n <= 105; ++n)
    chat.take({{{.n = n, .time_ms = 0, .session = kAnn, .name = "Ann", .color = "", .text = "a"}}});
  EXPECT_EQ(chat.part().lines.size(), 100u);
  EXPECT_EQ(chat.part().lines.front().n, 6u);
}

TEST(ChatLog, AfterAJoinBeginsWithWhatTheServerKept) {
  ChatLog chat;
  chat.take({{{.n = 1, .time_ms = 0, .session = kAnn, .name = "", .color = "", .text = "a"}}});
  chat.join(kMe);
  EXPECT_EQ(chat.part().lines.size(), 1u);
  chat.take({{{.n = 1, .time_ms = 0, .session = kAnn, .name = "", .color = "", .text = "a"},
              {.n = 2, .time_ms = 0, .session = kAnn, .name = "", .color = "", .text = "b"}}});
  EXPECT_EQ(chat.part().lines.size(), 2u);
}

TEST(ChatLog, OnesOwnLinesStayOnesOwnOverConnections) {
  ChatLog chat;
  chat.join("00000000000000e0");
  chat.clear();
  chat.join(kMe);
  chat.take(
      {{{.n = 1, .time_ms = 0, .session = "00000000000000e0", .name = "", .color = "", .text = "a"},
        {.n = 2, .time_ms = 0, .session = kAnn, .name = "", .color = "", .text = "b"},
        {.n = 3, .time_ms = 0, .session = kMe, .name = "", .color = "", .text = "c"}}});
  EXPECT_EQ(chat.part().mine, (std::vector<bool>{true, false, true}));
  for (std::uint64_t i = 0; i < kKeptSessions; ++i) chat.join(protocol::hex(i));
  EXPECT_EQ(chat.part().mine, (std::vector<bool>{false, false, false}));
}

TEST(Notices, KeepTwentyAndShowThemForAWhile) {
  Notices notices;
  for (int i = 1; i <= 25; ++i)
    notices.add(Notices::Kind::said, std::to_string(i), protocol::MapPoint{1, 2}, kStart);
  EXPECT_EQ(notices.part().notices.size(), 20u);
  EXPECT_EQ(notices.part().notices.front().n, 6u);
  EXPECT_EQ(notices.shown(kStart + 5s).size(), 20u);
  EXPECT_EQ(notices.due(kStart), kStart + 6s);
  EXPECT_TRUE(notices.shown(kStart + 6s).empty());
  EXPECT_FALSE(notices.due(kStart + 6s));
}

TEST(Notices, TheSameWordsAgainTakeTheirPlace) {
  Notices notices;
  notices.add(Notices::Kind::rejected, "full", protocol::MapPoint{1, 2}, kStart);
  notices.add(Notices::Kind::rejected, "full", protocol::MapPoint{3, 4}, kStart + 1s);
  ASSERT_EQ(notices.part().notices.size(), 1u);
  EXPECT_EQ(notices.part().notices[0].n, 2u);
  EXPECT_EQ(notices.part().notices[0].at, (protocol::MapPoint{3, 4}));
  notices.add(Notices::Kind::rejected, "full", protocol::MapPoint{3, 4}, kStart + 8s);
  EXPECT_EQ(notices.part().notices.size(), 2u);
}

TEST(CursorTeller, TellsChangesTwentyTimesASecondAndTheSameEveryTwentySeconds) {
  CursorTeller teller;
  const auto at = [](double x) {
    return protocol::Cursor{.at = protocol::MapPoint{x, 0}, .brush = {}, .view = {}, .id = {}};
  };
  EXPECT_TRUE(teller.tell(at(1), kStart));
  EXPECT_FALSE(teller.tell(at(2), kStart + 49ms));
  EXPECT_EQ(teller.due(), kStart + 50ms);
  EXPECT_TRUE(teller.tell(at(3), kStart + 50ms));
  EXPECT_FALSE(teller.tell(at(3), kStart + 20s));
  EXPECT_EQ(teller.due(), kStart + 20s + 50ms);
  EXPECT_TRUE(teller.tell(at(3), kStart + 20s + 50ms));
  teller.forget();
  EXPECT_TRUE(teller.tell(at(3), kStart + 21s));
}

TEST(CursorTeller, SaysNothingThatAServerRefuses) {
  const protocol::MapSettings settings = layered(2);
  const protocol::Brush held{.stencil = {}, .radius = 3, .fill = true, .layer = 1};
  const auto good = cursor_of(protocol::MapPoint{1e6, 0}, held, {-9e9, 0, 9e9, 1}, settings);
  EXPECT_TRUE(good.at);
  EXPECT_EQ(good.brush, held);
  EXPECT_TRUE(protocol::check_seen(*good.view, settings));
  EXPECT_FALSE(cursor_of(protocol::MapPoint{1e6 + 1, 0}, held, {}, settings).at);
  EXPECT_FALSE(cursor_of(protocol::MapPoint{0, 0}, protocol::Brush{.layer = 2}, {}, settings).at);
}

}  // namespace
}  // namespace earthwork::viewer
