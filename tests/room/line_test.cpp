// The line: first in, first out for an author, and fair between authors.
#include "server/room/line.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <string>

namespace earthwork::room {
namespace {

constexpr std::uint64_t kHuge = 10'000;

Line::Waiting edit(std::uint64_t author, protocol::MessageId id, std::uint64_t cost = 4,
                   std::size_t points = 1, std::int64_t since_ms = 0) {
  Line::Waiting waiting{.viewer = author,
                        .command = {.id = id, .author = author, .action = {}},
                        .cost = cost,
                        .since_ms = since_ms};
  std::get<protocol::Edit>(waiting.command.action).path.resize(points);
  return waiting;
}

/// As "author:id" of all that comes out, in order.
std::string drain(Line& line) {
  std::string out;
  while (!line.empty()) {
    const Command command = line.pop().command;
    if (!out.empty()) out += ' ';
    out += std::to_string(command.author) + ':' + std::to_string(command.id);
  }
  return out;
}

TEST(Line, IsFirstInFirstOutForOneAuthor) {
  Line line;
  for (int id = 1; id <= 4; ++id) ASSERT_TRUE(line.push(edit(7, id, id == 1 ? kHuge : 4)));
  EXPECT_EQ(line.size(), 4u);
  EXPECT_EQ(drain(line), "7:1 7:2 7:3 7:4");
  EXPECT_EQ(line.size(), 0u);
}

TEST(Line, TakesEqualAuthorsInTurn) {
  Line line;
  for (int id = 1; id <= 3; ++id) ASSERT_TRUE(line.push(edit(1, id)));
  for (int id = 1; id <= 3; ++id) ASSERT_TRUE(line.push(edit(2, id)));
  EXPECT_EQ(drain(line), "1:1 2:1 1:2 2:2 1:3 2:3");
}

TEST(Line, ACrowdOfHugeEditsDoesNotKeepSmallOnesOfOthersWaiting) {
  Line line;
  for (int id = 1; id <= 1000; ++id) ASSERT_TRUE(line.push(edit(1, id, kHuge)));
  EXPECT_EQ(line.pop().command.id, 1);
  for (int id = 1; id <= 100; ++id) ASSERT_TRUE(line.push(edit(2, id)));
  for (int id = 1; id <= 100; ++id) {
    const Command next = line.pop().command;
    EXPECT_EQ(next.author, 2u) << id;
    EXPECT_EQ(next.id, id);
  }
  EXPECT_EQ(line.pop().command.author, 1u);
}

TEST(Line, SharesTheWorkEvenly) {
  Line line;
  for (int id = 1; id <= 100; ++id) ASSERT_TRUE(line.push(edit(1, id, 1000)));
  for (int id = 1; id <= 1000; ++id) ASSERT_TRUE(line.push(edit(2, id, 100)));
  std::map<std::uint64_t, std::uint64_t> work;
  while (work[1] + work[2] < 50'000) {
    const Line::Waiting next = line.pop();
    work[next.command.author] += next.cost;
  }
  EXPECT_NEAR(static_cast<double>(work[1]), static_cast<double>(work[2]), 1000);
}

TEST(Line, WhoWasAwayGetsNoMoreThanOthersAfterwards) {
  Line line;
  for (int id = 1; id <= 100; ++id) ASSERT_TRUE(line.push(edit(1, id)));
  for (int id = 1; id <= 50; ++id) (void)line.pop();
  for (int id = 1; id <= 3; ++id) ASSERT_TRUE(line.push(edit(2, id)));
  std::string order;
  for (int i = 0; i < 6; ++i) order += std::to_string(line.pop().command.author);
  EXPECT_EQ(order.find("222"), std::string::npos) << order;
  EXPECT_NE(order.find("2"), std::string::npos) << order;
}

TEST(Line, AnEndlessRowOfNewAuthorsDoesNotStarveAnybody) {
  Line line;
  for (int id = 1; id <= 10; ++id) ASSERT_TRUE(line.push(edit(1, id)));
  int served = 0;
  for (std::uint64_t stranger = 100; stranger < 300; ++stranger) {
    ASSERT_TRUE(line.push(edit(stranger, 1, kHuge)));
    served += line.pop().command.author == 1 ? 1 : 0;
  }
  EXPECT_EQ(served, 10);
}

TEST(Line, ForgetsAuthorsWhoseWorkIsDoneAndKeepsTheOrder) {
  Line line;
  for (int id = 1; id <= 100; ++id) ASSERT_TRUE(line.push(edit(1, id, 100)));
  for (std::uint64_t stranger = 2; stranger < 10'000; ++stranger) {
    ASSERT_TRUE(line.push(edit(stranger, 1, 100)));
    if (line.size() > 200) (void)line.pop();
  }
  std::map<std::uint64_t, protocol::MessageId> last;
  while (!line.empty()) {
    const Command next = line.pop().command;
    EXPECT_GT(next.id, last[next.author]);
    last[next.author] = next.id;
  }
  EXPECT_EQ(last[1], 100);
}

TEST(Line, DoesNotForgetWhoIsStillAhead) {
  Line line;
  ASSERT_TRUE(line.push(edit(1, 1, 100 * kHuge)));
  EXPECT_EQ(line.pop().command.author, 1u);  // nobody else is there, and the clock starts anew
  ASSERT_TRUE(line.push(edit(1, 1, 100 * kHuge)) && line.push(edit(2, 1, 200 * kHuge)));
  EXPECT_EQ(line.pop().command.author, 1u);
  for (std::uint64_t stranger = 100; stranger < 3100; ++stranger) {
    ASSERT_TRUE(line.push(edit(stranger, 1)));
    (void)line.pop();
  }
  ASSERT_TRUE(line.push(edit(1, 2)) && line.push(edit(3, 1)) && line.push(edit(4, 1)));
  const std::string order = drain(line);
  EXPECT_TRUE(order.ends_with("1:2")) << order;
}

TEST(Line, SoManyPointsMayWaitAndNotOneMore) {
  Line line;
  for (int id = 1; id <= 4096; ++id)
    ASSERT_TRUE(line.push(edit(static_cast<std::uint64_t>(id % 7), id, 4, 1024)));
  EXPECT_EQ(line.points(), kMaxWaitingPoints);
  EXPECT_FALSE(line.push(edit(9, 1)));
  EXPECT_EQ(line.size(), 4096u);
  (void)line.pop();
  EXPECT_FALSE(line.push(edit(9, 1, 4, 1025)));
  EXPECT_TRUE(line.push(edit(9, 1, 4, 1024)));
  line.clear();
  EXPECT_EQ(line.points(), 0u);
  EXPECT_TRUE(line.empty());
}

TEST(Line, KnowsHowLongTheOldestHasWaited) {
  Line line;
  EXPECT_EQ(line.oldest_wait_ms(5000), 0);
  ASSERT_TRUE(line.push(edit(1, 1, kHuge, 1, 1000)));
  ASSERT_TRUE(line.push(edit(1, 2, kHuge, 1, 1500)));
  ASSERT_TRUE(line.push(edit(2, 1, 4, 1, 2000)));
  EXPECT_EQ(line.oldest_wait_ms(5000), 4000);
  (void)line.pop();  // of author 2, which costs less
  EXPECT_EQ(line.oldest_wait_ms(5000), 4000);
  (void)line.pop();
  EXPECT_EQ(line.oldest_wait_ms(5000), 3500);
  EXPECT_EQ(line.oldest_wait_ms(1000), 0);  // the clock was set back
}

TEST(Line, WhoIsPutAsideKeepsItsPlace) {
  Line line;
  for (int id = 1; id <= 2; ++id)
    for (const std::uint64_t author : {1u, 2u, 3u}) ASSERT_TRUE(line.push(edit(author, id)));
  EXPECT_EQ(line.next().command.author, 1u);
  line.put_aside();
  EXPECT_EQ(line.next().command.author, 2u);
  line.put_aside();
  ASSERT_TRUE(line.push(edit(1, 3)));
  EXPECT_EQ(line.pop().command.author, 3u);
  EXPECT_EQ(line.pop().command.author, 3u);
  EXPECT_FALSE(line.has_next());
  EXPECT_FALSE(line.empty());
  EXPECT_EQ(line.size(), 5u);
  EXPECT_EQ(line.points(), 5u);
  EXPECT_EQ(line.oldest_wait_ms(70), 70);

  ASSERT_TRUE(line.push(edit(4, 1)));
  line.recall();
  EXPECT_EQ(drain(line), "1:1 2:1 1:2 2:2 4:1 1:3");
  EXPECT_TRUE(line.empty());
}

TEST(Line, WhatWasPutAsideIsTakenByItsAuthor) {
  Line line;
  for (int id = 1; id <= 2; ++id)
    for (const std::uint64_t author : {1u, 2u}) ASSERT_TRUE(line.push(edit(author, id, 4, 3)));
  line.put_aside(), line.put_aside();
  EXPECT_EQ(line.take(2).command.id, 1);
  EXPECT_EQ(line.points(), 9u);
  EXPECT_EQ(line.next().command.author, 2u);
  EXPECT_EQ(line.next().command.id, 2);
  line.recall();
  EXPECT_EQ(drain(line), "1:1 1:2 2:2");
}

TEST(Line, ClearForgetsWhoWasPutAside) {
  Line line;
  ASSERT_TRUE(line.push(edit(1, 1)));
  line.put_aside();
  line.clear();
  line.recall();
  EXPECT_TRUE(line.empty());
  EXPECT_FALSE(line.has_next());
  EXPECT_EQ(line.size(), 0u);
}

/// Whatever comes and goes: each edit once, those of an author in order, and between two authors
/// who both wait all the while the work differs by no more than the largest edit of each.
TEST(Line, IsFairInEveryOrderOfEvents) {
  EXPECT_TRUE(rc::check([] {
    Line line;
    std::map<std::uint64_t, protocol::MessageId> pushed, popped;
    std::map<std::uint64_t, std::uint64_t> work;  // since all of 1, 2, 3 wait
    constexpr int kEach = 40;
    for (int id = 1; id <= kEach; ++id)
      for (std::uint64_t author = 1; author <= 3; ++author) {
        const auto cost = *rc::gen::inRange<std::uint64_t>(1, 1000);
        RC_ASSERT(line.push(edit(author, ++pushed[author], cost)));
      }
    for (int step = 0; !line.empty(); ++step) {
      if (step < 60 && *rc::gen::inRange(0, 3) == 0) {
        const auto other = *rc::gen::inRange<std::uint64_t>(4, 9);
        RC_ASSERT(
            line.push(edit(other, ++pushed[other], *rc::gen::inRange<std::uint64_t>(1, 1000))));
      }
      const Line::Waiting next = line.pop();
      const std::uint64_t author = next.command.author;
      RC_ASSERT(next.command.id == ++popped[author]);
      if (author > 3) continue;
      work[author] += next.cost;
      const bool all_wait = popped[1] < kEach && popped[2] < kEach && popped[3] < kEach;
      for (std::uint64_t other = 1; all_wait && other <= 3; ++other)
        RC_ASSERT(work[author] <= work[other] + 2000);
    }
    RC_ASSERT(pushed == popped);
    RC_ASSERT(line.points() == 0u);
  }));
}

}  // namespace
}  // namespace earthwork::room
