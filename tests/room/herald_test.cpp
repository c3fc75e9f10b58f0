// The herald: one talk at a time, people before events, and quiet when nothing happens.
#include "server/room/herald.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "server/room/manual_context.hpp"
#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"
#include "tests/room/manual_clerk.hpp"
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
  void point(ViewerId id, double x) {
    herald.point(id, {.at = {{x, 0}}, .brush = {}, .view = {}, .id = {}});
  }
  /// The texts of the lines that a viewer was told.
  std::vector<std::string> heard_lines(ViewerId id) const {
    std::vector<std::string> texts;
    for (const auto& line : eyes.at(id).chat()) texts.push_back(line.text);
    return texts;
  }
  void accept(std::size_t points = 1) {
    protocol::Edit edit = disc(1, 2, 3);
    edit.path.resize(points);
    edit.is_path = true;
    const history::Event event{
        .seq = past.last_seq() + 1, .time_ms = 0, .author = 7, .id = 1, .action = edit};
    ASSERT_TRUE(clerk.journal().append(event.seq - 1, {&event, 1}));
    past.add({&event, 1});
  }
  /// As long as it takes, and not much longer: the clerk and the viewers do what they can.
  void hear_all(std::initializer_list<ViewerId> ids, std::uint64_t to) {
    for (std::uint64_t n = 0; n < 10 + to; ++n) {
      clerk.run(1);
      context.run();
      for (const ViewerId id : ids) herald.heard(id);
    }
  }
  std::size_t heard_events(ViewerId id) const { return eyes.at(id).events().size(); }

  ManualContext context;
  std::unique_ptr<Strand> strand = context.make_strand();
  ManualClerk clerk{journal::make_memory_journal(journal::small_identity())};
  PastEvents past{clerk, back_at_once, 0};
  int tasks = 0;
  std::shared_ptr<ChatLog> log = std::make_shared<ChatLog>();
  Herald herald{past, *strand, log, [this](std::chrono::milliseconds delay, Strand::Task task) {
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

TEST_F(HeraldTest, TellsWhatIsSaidToAllAndAtOnce) {
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1), herald.heard(2);
  herald.say(2, "hello");
  EXPECT_TRUE(heard_lines(1).empty());  // not within the call
  context.run();
  ASSERT_EQ(eyes[1].chat().size(), 1u);
  const protocol::ChatLine line{.n = 1,
                                .time_ms = context.now().count(),
                                .session = user(2).session,
                                .name = "user 2",
                                .color = "#102030",
                                .text = "hello"};
  EXPECT_EQ(eyes[1].chat()[0], line);
  EXPECT_EQ(eyes[2].chat()[0], line);  // and to who said it
  EXPECT_EQ(log->last(), 1u);
  herald.say(3, "nobody");
  EXPECT_EQ(log->last(), 1u);
}

TEST_F(HeraldTest, TellsWhatIsSaidAtMostTenTimesASecond) {
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1);
  eyes[1].talks.clear();
  for (int i = 0; i < 100; ++i) {
    herald.say(2, "hello");
    context.advance(10ms);
    herald.heard(1);
  }
  EXPECT_LE(eyes[1].talks.size(), 11u);
  context.advance(100ms);
  herald.heard(1);
  ASSERT_EQ(eyes[1].chat().size(), 100u);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_EQ(eyes[1].chat()[i].n, i + 1);
}

TEST_F(HeraldTest, WhoComesIsToldWhatWasSaidWithoutWaitingForATick) {
  enter(1);
  herald.say(1, "one");
  context.run();
  enter(2);  // within the tenth of a second
  context.run();
  EXPECT_EQ(heard_lines(2), std::vector<std::string>{"one"});
  herald.say(1, "two");
  enter(3);
  context.run();
  EXPECT_EQ(heard_lines(3), (std::vector<std::string>{"one", "two"}));
  context.advance(1s);
  EXPECT_EQ(eyes[2].talks.size(), 1u);
  herald.heard(2);
  ASSERT_EQ(eyes[2].talks.size(), 2u);
  EXPECT_EQ(heard_lines(2), (std::vector<std::string>{"one", "two"}));
}

TEST_F(HeraldTest, ASlowReaderMissesLinesAndNotTheirOrder) {
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1);
  herald.say(2, "heard");
  context.advance(1s);
  for (int i = 0; i < 300; ++i) herald.say(2, std::to_string(i)), context.advance(150ms);
  const std::size_t before = eyes[1].talks.size();
  EXPECT_EQ(heard_lines(1), std::vector<std::string>{"heard"});
  herald.heard(1);
  EXPECT_EQ(eyes[1].talks.size(), before + 1);
  ASSERT_EQ(eyes[1].chat().size(), 101u);
  EXPECT_EQ(heard_lines(1)[1], "200");
  EXPECT_EQ(heard_lines(1)[100], "299");
}

TEST_F(HeraldTest, WhoLeftHearsNothingAndItsLinesStay) {
  enter(1), enter(2);
  herald.say(2, "bye");
  herald.leave(2);
  context.advance(1s);
  EXPECT_EQ(heard_lines(1), std::vector<std::string>{"bye"});
  EXPECT_TRUE(eyes[2].talks.empty());
  herald.leave_all();
  herald.say(1, "nobody");
  EXPECT_EQ(log->last(), 1u);
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
  for (int i = 0; i < 2000; ++i) accept(400);  // far beyond what is in memory
  herald.follow(1, 1);
  context.run();
  clerk.run();
  point(2, 77);
  context.run();
  herald.heard(1);
  const std::size_t told = heard_events(1);
  EXPECT_LT(told, 200u);
  ASSERT_EQ(eyes[1].people().size(), 2u);
  EXPECT_EQ(eyes[1].people()[1].cursors.at(0).at->x, 77);
}

TEST_F(HeraldTest, FollowersFromAnywhereArriveAtWhatHappensNow) {
  for (int i = 0; i < 600; ++i) accept(20);  // 500 of them beyond what is in memory
  enter(1), enter(2), enter(3);
  herald.follow(1, 1), herald.follow(2, 300), herald.follow(3, 601);
  hear_all({1, 2, 3}, 40);
  for (int i = 0; i < 5; ++i) accept();
  herald.tell_events();
  hear_all({1, 2, 3}, 10);
  for (const auto& [id, from] : {std::pair{1u, 1u}, {2u, 300u}, {3u, 601u}}) {
    const auto events = eyes[id].events();
    ASSERT_EQ(events.size(), 606 - from) << id;
    for (std::size_t i = 0; i < events.size(); ++i) ASSERT_EQ(events[i].seq, from + i) << id;
  }
}

TEST_F(HeraldTest, ABusyReaderOfThePastKeepsNobodyWaiting) {
  for (int i = 0; i < 2000; ++i) accept(100);
  enter(1), enter(2);
  context.advance(1s);
  herald.heard(1), herald.heard(2);
  herald.follow(1, 1), herald.follow(2, 2001);
  context.run();
  for (std::size_t i = 0; i < 5; ++i) {
    clerk.run(1);
    herald.heard(1);
    accept();
    herald.tell_events();  // the one who reads waits for a page, or hears
    ASSERT_EQ(heard_events(2), i + 1);
    herald.heard(2);
  }
  EXPECT_GT(heard_events(1), 30u);
}

TEST_F(HeraldTest, NothingIsReadForWhoDoesNotHear) {
  for (int i = 0; i < 2000; ++i) accept(100);
  enter(1);
  herald.follow(1, 1);
  context.run();
  EXPECT_EQ(clerk.run(), 2);  // one was told, and the next is at hand
  accept();
  herald.tell_events();
  EXPECT_EQ(clerk.waiting(), 0u);
  herald.leave(1);
  EXPECT_EQ(clerk.run(), 0);
  enter(2);  // what nobody reads any more is not kept
  herald.follow(2, 1);
  context.run();
  EXPECT_EQ(heard_events(2), 0u);
  EXPECT_EQ(clerk.waiting(), 1u);
}

TEST(Herald, TellsWhoseEventsCannotBeReadAndGoesOn) {
  auto tampered =
      std::make_unique<journal::TamperedJournal>(journal::journal_of(journal::ten_events()));
  tampered->unreadable_event = 3;
  ManualClerk clerk(std::move(tampered));
  PastEvents past(clerk, back_at_once, 10);
  ManualContext context;
  const auto strand = context.make_strand();
  Herald herald(
      past, *strand, std::make_shared<ChatLog>(),
      [&](std::chrono::milliseconds, Strand::Task task) { strand->post(std::move(task)); });
  Onlooker ann, bob;
  herald.enter(1, ann, user(1)), herald.enter(2, bob, user(2));
  context.run(5), herald.heard(1), herald.heard(2);
  ann.talks.clear();
  herald.follow(1, 2), herald.follow(2, 4);
  context.run(5);
  clerk.run();
  ASSERT_EQ(ann.talks.size(), 1u);
  EXPECT_NE(ann.talks[0].messages.back()->find(R"("code":"damaged")"), std::string::npos);
  EXPECT_EQ(bob.events().size(), 7u);
  herald.heard(1), herald.heard(2);
  const history::Event next{.seq = 11, .time_ms = 0, .author = 7, .id = 1, .action = disc(1, 1, 1)};
  past.add({&next, 1});
  herald.tell_events();
  EXPECT_EQ(ann.talks.size(), 1u);
  EXPECT_EQ(bob.events().size(), 8u);
}

/// Makes the events of a log that nobody could hold.
struct LongLog final : journal::Journal {
  explicit LongLog(std::uint64_t count) : count_(count) {}
  const journal::Identity& identity() const override { return identity_; }
  std::uint64_t last_seq() const override { return count_; }
  protocol::Result<std::vector<history::Event>> events(std::uint64_t from,
                                                       std::size_t most_bytes) override {
    std::vector<history::Event> page;
    for (std::size_t bytes = 0; bytes < most_bytes && from <= count_; bytes += 100)
      page.push_back({.seq = from++, .time_ms = 0, .author = 7, .id = 1, .action = disc(1, 1, 1)});
    return page;
  }
  protocol::Result<void> append(std::uint64_t, std::span<const history::Event>) override {
    return {};
  }
  protocol::Result<void> put_chunks(std::span<const journal::ChunkState>) override { return {}; }
  protocol::Result<void> put_authors(std::span<const journal::AuthorState>) override { return {}; }
  protocol::Result<void> put_keyframe(const journal::Keyframe&) override { return {}; }
  protocol::Result<bool> tidy(std::size_t) override { return true; }
  protocol::Result<std::vector<journal::Keyframe>> keyframes() override { return {}; }
  protocol::Result<void> chunks(
      std::uint64_t, const std::function<protocol::Result<void>(journal::ChunkState)>&) override {
    return {};
  }
  protocol::Result<std::vector<journal::AuthorState>> authors() override { return {}; }

 private:
  journal::Identity identity_ = journal::small_identity();
  std::uint64_t count_;
};

/// Counts what it hears, checks the numbers, and forgets it.
struct Listener final : Viewer {
  void answered(std::vector<Reply>) override {}
  void deliver(Parcel) override {}
  void settings(SharedText) override {}
  void end(protocol::Bye) override {}
  void tell(Talk talk) override {
    for (const SharedText& text : talk.messages) {
      texts.push_back(text);
      if (texts.size() > 50'000) texts.pop_front();
      if (text->rfind(R"({"type":"event","seq":)" + std::to_string(next) + ",", 0) == 0) ++next;
    }
  }
  std::uint64_t next = 1;
  std::deque<std::weak_ptr<const std::string>> texts;
};

TEST(Herald, ALongPastIsTakenInWithinBounds) {
  constexpr std::uint64_t kCount = 200'000;
  ManualClerk clerk(std::make_unique<LongLog>(kCount));
  PastEvents past(clerk, back_at_once, kCount);
  ManualContext context;
  const auto strand = context.make_strand();
  Herald herald(
      past, *strand, std::make_shared<ChatLog>(),
      [&](std::chrono::milliseconds, Strand::Task task) { strand->post(std::move(task)); });
  Listener reader;
  herald.enter(1, reader, user(1));
  herald.follow(1, 1);
  context.run(10);
  for (int n = 0; n < 10'000 && reader.next <= kCount; ++n) {
    clerk.run(1);
    ASSERT_LE(clerk.waiting(), 1u);
    herald.heard(1);
  }
  EXPECT_EQ(reader.next, kCount + 1);
  std::size_t held = 0;
  for (const auto& text : reader.texts)
    if (const SharedText still = text.lock()) held += still->size();
  EXPECT_LE(held, std::size_t{1} << 20);
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
