// The herald: one talk at a time, people before events, and quiet when nothing happens.
#include "server/room/herald.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "server/room/manual_context.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Presence;

protocol::User user(std::uint64_t n) {
  return {protocol::hex(n), "user " + std::to_string(n), "#102030", protocol::hex(n)};
}

struct HeraldTest : testing::Test {
  void enter(ViewerId id) { herald.enter(id, eyes[id], user(id)); }
  void point(ViewerId id, double x) { herald.point(id, {.at = {{x, 0}}, .brush = {}, .id = {}}); }
  void accept(std::size_t points = 1) {
    protocol::Edit edit = disc(1, 2, 3);
    edit.path.resize(points);
    edit.is_path = true;
    events.push_back({.seq = events.size() + 1, .time_ms = 0, .author = 7, .id = 1, .edit = edit});
  }
  std::size_t heard_events(ViewerId id) const { return eyes.at(id).events().size(); }

  ManualContext context;
  std::unique_ptr<Strand> strand = context.make_strand();
  std::vector<history::Event> events;
  int tasks = 0;
  Herald herald{events, *strand, [this](std::chrono::milliseconds delay, Strand::Task task) {
                  ++tasks;
                  if (delay == 0ms)
                    strand->post(std::move(task));
                  else
                    strand->post_after(delay, std::move(task));
                }};
  std::map<ViewerId, Onlooker> eyes;
};

TEST_F(HeraldTest, TellsTheFirstChangeAtOnce) {
  enter(1);
  context.advance(1s);
  EXPECT_TRUE(eyes[1].talks.empty());  // it knows that it came
  enter(2);
  EXPECT_TRUE(eyes[1].talks.empty());  // not within the call
  context.run();
  ASSERT_EQ(eyes[1].talks.size(), 1u);
  EXPECT_EQ(eyes[1].people().at(0).users, std::vector<protocol::User>{user(2)});
  EXPECT_TRUE(eyes[2].talks.empty());
}

TEST_F(HeraldTest, TellsOfPeopleAtMostTenTimesASecond) {
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1), herald.heard(2);
  eyes[1].talks.clear();
  for (int i = 0; i < 400; ++i) {
    point(2, i);
    context.advance(10ms);
    herald.heard(1);
  }
  EXPECT_GE(eyes[1].talks.size(), 38u);
  EXPECT_LE(eyes[1].talks.size(), 41u);
  context.advance(100ms);
  herald.heard(1);
  EXPECT_EQ(eyes[1].people().back().cursors.at(0).at->x, 399);
}

TEST_F(HeraldTest, IsQuietWhenNothingChanges) {
  enter(1), enter(2);
  point(2, 5);
  context.advance(1s);
  herald.heard(1);
  const int before = tasks;
  point(2, 5);
  context.advance(10s);
  EXPECT_EQ(tasks, before);
  EXPECT_EQ(eyes[1].talks.size(), 1u);
}

TEST_F(HeraldTest, HidesACursorAfterThirtySeconds) {
  enter(1), enter(2);
  point(2, 5);
  context.advance(20s);
  herald.heard(1);
  point(2, 5);
  context.advance(29'999ms);
  EXPECT_EQ(eyes[1].people().size(), 1u);
  context.advance(101ms);
  ASSERT_EQ(eyes[1].people().size(), 2u);
  EXPECT_FALSE(eyes[1].people()[1].cursors.at(0).at);
  const int before = tasks;
  context.advance(100s);
  EXPECT_LE(tasks, before + 1);
}

TEST_F(HeraldTest, TellsASlowViewerOneThingAtATime) {
  enter(1), enter(2);
  context.advance(1s);
  EXPECT_EQ(eyes[1].talks.size(), 1u);
  for (int i = 0; i < 50; ++i) point(2, i), context.advance(200ms);
  EXPECT_EQ(eyes[1].talks.size(), 1u);
  herald.heard(1);
  ASSERT_EQ(eyes[1].talks.size(), 2u);
  EXPECT_EQ(eyes[1].people()[1].cursors.at(0).at->x, 49);
}

TEST_F(HeraldTest, ACrowdThatComesInIsWrittenForAFewTimes) {
  for (ViewerId id = 1; id <= 1000; ++id) enter(id);
  context.advance(1s);
  std::set<const std::string*> texts;
  std::size_t told = 0;
  for (const auto& [id, viewer] : eyes)
    for (const Talk& talk : viewer.talks)
      for (const SharedText& text : talk.messages) texts.insert(text.get()), ++told;
  EXPECT_EQ(told, 1000u);
  EXPECT_EQ(texts.size(), 2u);  // for those who were told of all in joined, and for the others
}

TEST_F(HeraldTest, TellsEventsOfThePastAndThoseToCome) {
  enter(1);
  accept(), accept(), accept();
  herald.follow(1, 2);
  EXPECT_TRUE(eyes[1].talks.empty());  // not within the call
  context.run();
  EXPECT_EQ(heard_events(1), 2u);
  accept();
  herald.tell_events();
  EXPECT_EQ(heard_events(1), 2u);  // the last talk was not heard yet
  herald.heard(1);
  EXPECT_EQ(heard_events(1), 3u);
  herald.heard(1);
  accept();
  herald.tell_events();
  EXPECT_EQ(heard_events(1), 4u);
  EXPECT_EQ(eyes[1].events().back().seq, 5u);
}

TEST_F(HeraldTest, ATalkIsBoundedAndPeopleComeFirst) {
  enter(1);
  for (int i = 0; i < 40; ++i) accept(400);  // 4 KB each
  herald.follow(1, 1);
  for (ViewerId id = 2; id <= 300; ++id) enter(id);  // some 30 KB
  context.advance(1s);
  for (int i = 0; i < 10; ++i) herald.heard(1);
  EXPECT_EQ(heard_events(1), 40u);
  ASSERT_EQ(eyes[1].people().size(), 1u);
  EXPECT_EQ(eyes[1].people()[0].users.size(), 300u);
  for (const Talk& talk : eyes[1].talks) {
    std::size_t bytes = 0;
    for (const SharedText& text : talk.messages) bytes += text->size();
    EXPECT_LE(bytes, kMaxTalkBytes);
  }
  EXPECT_EQ(eyes[1].talks.front().messages.front()->find(R"({"type":"presence")"), 0u);
}

TEST_F(HeraldTest, EventsDoNotKeepPeopleWaiting) {
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1);
  for (int i = 0; i < 2000; ++i) accept(400);
  herald.follow(1, 1);
  context.run();
  point(2, 77);
  context.run();
  herald.heard(1);
  const std::size_t told = heard_events(1);
  EXPECT_LT(told, 200u);
  ASSERT_EQ(eyes[1].people().size(), 2u);
  EXPECT_EQ(eyes[1].people()[1].cursors.at(0).at->x, 77);
}

TEST_F(HeraldTest, TellsALeaverNothing) {
  enter(1), enter(2);
  accept();
  herald.follow(2, 1);
  herald.leave(2);
  context.advance(1s);
  herald.heard(2), herald.tell_events(), point(2, 1), herald.follow(2, 1);
  context.advance(1s);
  EXPECT_TRUE(eyes[2].talks.empty());
  EXPECT_EQ(eyes[1].people().at(0).left, std::vector<std::string>{user(2).session});
  herald.leave_all();
  enter(3);
  context.advance(1s);
  EXPECT_EQ(herald.users_for(3), std::vector<protocol::User>{user(3)});
  EXPECT_EQ(eyes[1].talks.size(), 1u);
}

}  // namespace
}  // namespace earthwork::room
