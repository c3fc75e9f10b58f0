// The presence board: who is there and where they point, told by versions.
#include "server/room/presence_board.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "protocol/limits.hpp"

namespace earthwork::room {
namespace {

using protocol::Presence;

std::string session(std::uint64_t n) { return protocol::hex(n); }

protocol::User user(std::uint64_t n) {
  return {session(n), "user " + std::to_string(n), "#102030", protocol::hex(n + 1000)};
}

protocol::Cursor at(double x, double y) {
  return {.at = {{x, y}}, .brush = {}, .view = {}, .id = {}};
}
protocol::Cursor nowhere() { return {.at = {}, .brush = {}, .view = {}, .id = {}}; }

struct Board : PresenceBoard {
  void join(ViewerId id) { enter(id, user(id)); }
  /// Of the current version; nothing when there is no message.
  std::optional<Presence> news(ViewerId id) {
    const SharedText text = news_for(id);
    if (!text) return std::nullopt;
    EXPECT_LE(text->size(), protocol::kMaxServerControlBytes);
    return std::get<Presence>(protocol::parse_server_message(*text).value());
  }
};

/// Two who know of each other.
struct PresenceBoardTest : testing::Test {
  PresenceBoardTest() {
    board.join(1), board.join(2);
    settle();
  }
  void settle() {
    board.advance();
    for (ViewerId id = 1; id <= 9; ++id) (void)board.news_for(id);
  }
  Board board;
};

TEST_F(PresenceBoardTest, SaysWhoCame) {
  board.join(3);
  EXPECT_TRUE(board.changed());
  EXPECT_FALSE(board.news(1));  // not before the next version
  board.advance();
  EXPECT_FALSE(board.changed());
  EXPECT_EQ(board.news(1), (Presence{.all = false, .users = {user(3)}, .left = {}, .cursors = {}}));
  EXPECT_FALSE(board.news(1));
  EXPECT_FALSE(board.news(3));  // who came knows that it did
}

TEST_F(PresenceBoardTest, SaysWhoLeft) {
  board.leave(2);
  board.advance();
  EXPECT_EQ(board.news(1),
            (Presence{.all = false, .users = {}, .left = {session(2)}, .cursors = {}}));
  EXPECT_FALSE(board.news(2));
  EXPECT_EQ(board.users_for(1), std::vector<protocol::User>{user(1)});
}

TEST_F(PresenceBoardTest, SaysWhereTheyPointAndWithWhat) {
  protocol::Cursor cursor = at(3, -4.5);
  cursor.brush = protocol::Brush{.radius = 2, .fill = false, .layer = 1};
  board.point(2, cursor, 0);
  board.advance();
  const Presence moved{.all = false,
                       .users = {},
                       .left = {},
                       .cursors = {{session(2), protocol::MapPoint{3, -4.5}, cursor.brush, {}}}};
  EXPECT_EQ(board.news(1), moved);
  EXPECT_FALSE(board.news(2));  // it knows where it points
  board.point(2, nowhere(), 0);
  board.advance();
  EXPECT_EQ(
      board.news(1),
      (Presence{.all = false, .users = {}, .left = {}, .cursors = {{session(2), {}, {}, {}}}}));
}

TEST_F(PresenceBoardTest, OfManyPlacesTheLastOneCounts) {
  for (int i = 0; i <= 40; ++i) board.point(2, at(i, 0), i);
  board.advance();
  const auto news = board.news(1);
  ASSERT_EQ(news->cursors.size(), 1u);
  EXPECT_EQ(news->cursors[0].at->x, 40);
}

TEST_F(PresenceBoardTest, TheSamePlaceAgainIsNoNews) {
  board.point(2, at(1, 1), 0);
  settle();
  board.point(2, at(1, 1), 5000);
  EXPECT_FALSE(board.changed());
  board.point(3, at(1, 1), 5000);  // nobody
  EXPECT_FALSE(board.changed());
}

TEST_F(PresenceBoardTest, HidesACursorThatIsNotSaidAgain) {
  board.point(1, at(1, 1), 1000), board.point(2, at(2, 2), 2000);
  settle();
  board.point(1, at(1, 1), 9000);
  EXPECT_EQ(board.hide_old(31'999), 32'000);
  EXPECT_FALSE(board.changed());
  EXPECT_EQ(board.hide_old(32'000), 39'000);
  board.advance();
  const auto news = board.news(1);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->cursors[0].session, session(2));
  EXPECT_FALSE(news->cursors[0].at);
  EXPECT_EQ(board.hide_old(39'000), std::nullopt);
  EXPECT_TRUE(board.changed());
}

TEST_F(PresenceBoardTest, SaysWhatTheySee) {
  const protocol::MapRect seen{-8, 0, 8.5, 16};
  board.point(2, {.at = {{1, 1}}, .brush = {}, .view = seen, .id = {}}, 0);
  board.advance();
  EXPECT_EQ(board.news(1)->cursors.at(0).view, seen);
  const protocol::MapRect next{-7, 0, 9.5, 16};
  board.point(2, {.at = {{1, 1}}, .brush = {}, .view = next, .id = {}}, 0);
  board.advance();
  EXPECT_EQ(board.news(1)->cursors.at(0).view, next);
  board.point(2, at(1, 1), 0);  // it does not say any more
  board.advance();
  EXPECT_FALSE(board.news(1)->cursors.at(0).view);
}

TEST_F(PresenceBoardTest, WhatSomebodySeesOutlastsItsCursor) {
  const protocol::MapRect seen{-8, 0, 8.5, 16};
  board.point(2, {.at = {{1, 1}}, .brush = {}, .view = seen, .id = {}}, 0);
  settle();
  EXPECT_EQ(board.hide_old(kCursorMs), std::nullopt);
  board.advance();
  const auto news = board.news(1);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->cursors.at(0), (protocol::UserCursor{session(2), {}, {}, seen}));
  board.point(2, {.at = {}, .brush = {}, .view = seen, .id = {}}, 0);
  EXPECT_FALSE(board.changed());
}

TEST_F(PresenceBoardTest, ANewcomerIsToldWhatTheOthersSeeWithoutACursorToo) {
  const protocol::MapRect seen{-8, 0, 8.5, 16};
  board.point(1, {.at = {}, .brush = {}, .view = seen, .id = {}}, 0);
  settle();
  board.join(3);
  board.advance();
  EXPECT_EQ(board.news(3)->cursors,
            (std::vector<protocol::UserCursor>{{session(1), {}, {}, seen}}));
}

TEST_F(PresenceBoardTest, ANewcomerIsToldOfTheCursorsThatThereAre) {
  board.point(1, at(1, 1), 0);
  settle();
  board.join(3);
  board.advance();
  const auto news = board.news(3);
  ASSERT_TRUE(news);
  EXPECT_FALSE(news->all);
  ASSERT_EQ(news->cursors.size(), 1u);
  EXPECT_EQ(news->cursors[0].session, session(1));
  EXPECT_TRUE(board.news(2)->cursors.empty());
}

TEST_F(PresenceBoardTest, WhoMissedVersionsIsToldAllOfThemAtOnce) {
  board.join(3);
  board.advance();
  board.point(3, at(1, 1), 0);
  board.advance();
  board.point(3, at(2, 2), 0);
  board.join(4);
  board.leave(2);
  board.advance();
  const auto news = board.news(1);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->users, (std::vector<protocol::User>{user(3), user(4)}));
  EXPECT_EQ(news->left, std::vector<std::string>{session(2)});
  ASSERT_EQ(news->cursors.size(), 1u);
  EXPECT_EQ(news->cursors[0].at->x, 2);
}

TEST_F(PresenceBoardTest, ASessionThatIsBackIsNotSaidToHaveLeft) {
  board.point(2, at(1, 1), 0);
  settle();
  board.leave(2);
  board.enter(5, user(2));
  board.advance();
  const auto news = board.news(1);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->users, std::vector<protocol::User>{user(2)});
  EXPECT_TRUE(news->left.empty());
  ASSERT_EQ(news->cursors.size(), 1u);  // the one of before is gone
  EXPECT_FALSE(news->cursors[0].at);
}

TEST_F(PresenceBoardTest, WritesTheSameNewsOnce) {
  for (ViewerId id = 3; id <= 1000; ++id) board.join(id);
  board.advance();
  std::set<const std::string*> texts;
  for (ViewerId id = 1; id <= 1000; ++id)
    if (const SharedText text = board.news_for(id)) texts.insert(text.get());
  // For the two, for those who came when `joined` listed all, and for the others.
  EXPECT_EQ(texts.size(), 3u);
}

TEST_F(PresenceBoardTest, WhoIsSoFarBehindIsToldEverythingAnew) {
  board.point(2, at(1, 1), 0);
  for (int i = 0; i < 64; ++i) board.join(3), board.advance(), board.leave(3);
  EXPECT_FALSE(Board(board).news(1)->all);
  board.advance();
  const auto news = board.news(1);
  ASSERT_TRUE(news);
  EXPECT_TRUE(news->all);
  EXPECT_EQ(news->users, (std::vector<protocol::User>{user(1), user(2)}));
  EXPECT_TRUE(news->left.empty());
  ASSERT_EQ(news->cursors.size(), 1u);
}

TEST_F(PresenceBoardTest, SoManyDeparturesAreRememberedAndNotOneMore) {
  for (ViewerId id = 100; id < 1100; ++id) board.join(id);  // 998 of them are listed
  settle();
  for (ViewerId id = 100; id < 1098; ++id) board.leave(id);
  for (ViewerId id = 1; id <= 24; ++id) board.enter(2000 + id, user(2000 + id));
  board.advance();
  for (ViewerId id = 1; id <= 24; ++id) board.leave(2000 + id);
  board.advance();
  EXPECT_EQ(Board(board).news(1)->left.size(), 1022u);
  for (ViewerId id = 1; id <= 3; ++id) board.enter(3000 + id, user(3000 + id));
  board.advance();
  for (ViewerId id = 1; id <= 2; ++id) board.leave(3000 + id);
  board.advance();
  EXPECT_EQ(Board(board).news(1)->left.size(), 1024u);
  board.leave(3003);
  board.advance();
  EXPECT_TRUE(board.news(1)->all);
}

TEST_F(PresenceBoardTest, ListsSoManyAndNotOneMore) {
  for (ViewerId id = 3; id <= 1001; ++id) board.join(id);
  board.point(1001, at(1, 1), 0);
  board.advance();
  auto news = board.news(1);
  EXPECT_EQ(news->users.size(), 998u);
  EXPECT_TRUE(news->cursors.empty());
  EXPECT_EQ(board.news(1001)->users.size(), 1000u);  // it sees the others all the same

  board.leave(500);
  board.advance();
  news = board.news(1);
  EXPECT_EQ(news->users, std::vector<protocol::User>{user(1001)});
  EXPECT_EQ(news->left, std::vector<std::string>{session(500)});
  EXPECT_EQ(news->cursors.size(), 1u);
}

TEST_F(PresenceBoardTest, AllAreListedAtOnceUpToSoManyAndNotOneMore) {
  for (ViewerId id = 3; id <= 64; ++id) board.join(id);
  ASSERT_EQ(board.users_for(64).size(), 64u);
  EXPECT_EQ(board.users_for(64).back(), user(64));
  board.join(65);
  ASSERT_EQ(board.users_for(65).size(), 64u);
  EXPECT_EQ(board.users_for(65).front(), user(1));
  EXPECT_EQ(board.users_for(65).back(), user(65));
  board.advance();
  EXPECT_FALSE(board.news(64)->all);
  const auto news = board.news(65);
  EXPECT_TRUE(news->all);
  EXPECT_EQ(news->users.size(), 65u);
}

TEST_F(PresenceBoardTest, WhoIsNotListedIsToldOfTheOthersToo) {
  for (ViewerId id = 3; id <= 1000; ++id) board.join(id);
  board.point(1, at(1, 1), 0);
  board.advance();
  (void)board.news(2);
  board.join(1001);
  ASSERT_TRUE(board.changed());
  board.advance();
  const auto news = board.news(1001);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->users.size(), 1000u);
  EXPECT_EQ(news->cursors.size(), 1u);
  EXPECT_FALSE(board.news(2));  // they are not told of it
}

TEST(PresenceBoard, AMessageOfTheMostAndLongestFits) {
  Board board;
  std::string longest;
  for (int i = 0; i < 64; ++i) longest += "\xF0\x9F\x8C\x8D";
  for (ViewerId id = 1; id <= kMaxListedUsers; ++id) {
    protocol::User one = user(id);
    one.name = longest;
    board.enter(id, one);
    protocol::Cursor cursor = at(-1.2345678901234567e-300, -1.2345678901234567e-300);
    cursor.brush = protocol::Brush{.radius = 1.2345678901234567e-300, .fill = false, .layer = 15};
    constexpr double kLong = -1.2345678901234567e-300;
    cursor.view = protocol::MapRect{kLong, kLong, -kLong, -kLong};
    board.point(id, cursor, 0);
  }
  board.advance();
  const auto news = board.news(700);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->users.size(), 1000u);
  EXPECT_EQ(news->cursors.size(), 1000u);
}

/// What a client holds that does what the protocol says of a presence.
struct Reader {
  std::map<std::string, protocol::User> users;
  std::map<std::string, protocol::UserCursor> cursors;

  void take(const Presence& news) {
    if (news.all) users.clear(), cursors.clear();
    for (const auto& one : news.left) users.erase(one), cursors.erase(one);
    for (const auto& one : news.users) users[one.session] = one;
    for (const auto& one : news.cursors) {
      cursors.erase(one.session);
      if (one.at || one.view) cursors[one.session] = one;
    }
  }
};

/// However rarely each of them listens: in the end all hold the same, and it is true.
TEST(PresenceBoard, EverybodyEndsWithTheSamePicture) {
  EXPECT_TRUE(rc::check([] {
    Board board;
    std::map<ViewerId, Reader> readers;
    std::map<ViewerId, std::uint64_t> sessions;        // of those who are there
    std::map<std::string, protocol::UserCursor> said;  // of those who point or see
    ViewerId last = 0;
    const auto listen = [&](ViewerId id) {
      if (const auto news = board.news(id)) readers[id].take(*news);
    };
    const int steps = *rc::gen::inRange(0, 150);
    for (int i = 0; i < steps; ++i) {
      const auto one = *rc::gen::inRange<std::uint64_t>(1, 8);  // a session, there or not
      const auto found = std::find_if(sessions.begin(), sessions.end(),
                                      [&](const auto& s) { return s.second == one; });
      const int what = *rc::gen::inRange(0, 7);
      if (found == sessions.end()) {
        board.enter(++last, user(one));
        sessions[last] = one;
        for (const auto& other : board.users_for(last)) readers[last].users[other.session] = other;
      } else if (what == 0) {
        board.leave(found->first);
        readers.erase(found->first);
        said.erase(session(one));
        sessions.erase(found);
      } else if (what <= 3) {
        protocol::Cursor cursor = nowhere();
        if (*rc::gen::inRange(0, 3) > 0)
          cursor.at = protocol::MapPoint{*rc::gen::inRange(0, 3) * 1.0, 0};
        if (*rc::gen::inRange(0, 3) == 0)
          cursor.view = protocol::MapRect{0, 0, *rc::gen::inRange(1, 3) * 1.0, 1};
        said.erase(session(one));
        if (cursor.at || cursor.view)
          said[session(one)] = {session(one), cursor.at, {}, cursor.view};
        board.point(found->first, cursor, 0);
      } else if (what == 4) {
        board.advance();
      } else {
        listen(found->first);
      }
    }
    board.advance();
    for (const auto& [id, one] : sessions) {
      listen(id);
      RC_ASSERT(readers[id].users.size() == sessions.size());
      auto others = said;
      others.erase(session(one));  // of itself it need not be told
      readers[id].cursors.erase(session(one));
      RC_ASSERT(readers[id].cursors == others);
    }
  }));
}

}  // namespace
}  // namespace earthwork::room
