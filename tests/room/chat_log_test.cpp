// What was said is kept: a hundred lines a map, and of all maps together so many bytes.
#include "server/room/chat_log.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "protocol/limits.hpp"

namespace earthwork::room {
namespace {

protocol::ChatLine line(std::string text) {
  return {.time_ms = 5, .session = "s", .name = "ann", .color = "#102030", .text = std::move(text)};
}

std::vector<std::uint64_t> numbers(const ChatLog& log, std::uint64_t after = 0) {
  std::vector<std::uint64_t> numbers;
  for (const auto& kept : log.after(after)) numbers.push_back(kept.n);
  return numbers;
}

TEST(ChatLog, NumbersLinesFromOne) {
  ChatLog log;
  EXPECT_EQ(log.last(), 0u);
  EXPECT_EQ(numbers(log), std::vector<std::uint64_t>{});
  EXPECT_EQ(log.add(line("a")), 1u);
  EXPECT_EQ(log.add(line("b")), 2u);
  ASSERT_EQ(log.after(0).size(), 2u);
  EXPECT_EQ(log.after(0)[1], (protocol::ChatLine{2, 5, "s", "ann", "#102030", "b"}));
  EXPECT_EQ(numbers(log, 1), std::vector<std::uint64_t>{2});
  EXPECT_EQ(numbers(log, 2), std::vector<std::uint64_t>{});
}

TEST(ChatLog, KeepsTheLastHundred) {
  ChatLog log;
  for (int i = 0; i < 100; ++i) log.add(line("x"));
  EXPECT_EQ(numbers(log).front(), 1u);
  log.add(line("x"));
  EXPECT_EQ(numbers(log).front(), 2u);
  EXPECT_EQ(numbers(log).size(), 100u);
  EXPECT_EQ(log.last(), 101u);
}

TEST(ChatArchive, BeyondItsBoundTheOldestLineGoesWhoeversItIs) {
  const auto archive = std::make_shared<ChatArchive>(5000);
  ChatLog quiet(archive), loud(archive);
  const std::string fill(900, 'x');
  quiet.add(line(fill)), loud.add(line(fill)), quiet.add(line(fill));
  while (numbers(quiet).size() == 2) loud.add(line(fill));
  EXPECT_EQ(numbers(quiet), std::vector<std::uint64_t>{2});
  EXPECT_EQ(numbers(loud).front(), 1u);  // said after the quiet one's first
  for (int i = 0; i < 9; ++i) loud.add(line(fill));
  EXPECT_EQ(numbers(quiet), std::vector<std::uint64_t>{});
  EXPECT_LE(archive->bytes(), 5000u);
  EXPECT_EQ(quiet.add(line("again")), 3u);  // numbers are not taken twice
  EXPECT_EQ(numbers(quiet), std::vector<std::uint64_t>{3});
}

TEST(ChatArchive, ALineThatIsLargerThanAllIsNotKept) {
  const auto archive = std::make_shared<ChatArchive>(1000);
  ChatLog log(archive);
  EXPECT_EQ(log.add(line(std::string(1000, 'x'))), 1u);
  EXPECT_EQ(numbers(log), std::vector<std::uint64_t>{});
  EXPECT_EQ(archive->bytes(), 0u);
}

TEST(ChatArchive, ALogTakesItsLinesWithIt) {
  const auto archive = std::make_shared<ChatArchive>();
  ChatLog stays(archive);
  stays.add(line("a"));
  const std::size_t before = archive->bytes();
  {
    ChatLog goes(archive);
    goes.add(line("b")), stays.add(line("c")), goes.add(line("d"));
  }
  EXPECT_EQ(archive->bytes(), 2 * before);
  EXPECT_EQ(numbers(stays), (std::vector<std::uint64_t>{1, 2}));
}

TEST(ChatArchive, AThousandFullMapsStayWithinTheBound) {
  const auto archive = std::make_shared<ChatArchive>();
  std::vector<std::unique_ptr<ChatLog>> logs;
  const std::string longest(2000, 'x');
  for (int i = 0; i < 1000; ++i) {
    logs.push_back(std::make_unique<ChatLog>(archive));
    for (int n = 0; n < 100; ++n) logs.back()->add(line(longest));
  }
  EXPECT_LE(archive->bytes(), kMaxChatBytes);
  EXPECT_GT(archive->bytes(), kMaxChatBytes - 4000);
  EXPECT_EQ(numbers(*logs.back()).size(), 100u);
  EXPECT_EQ(numbers(*logs.front()).size(), 0u);
}

/// Whatever is said where, and whichever log goes: each log holds its last lines without a gap.
TEST(ChatArchive, EveryLogKeepsAnEndOfWhatItWasTold) {
  EXPECT_TRUE(rc::check([] {
    const auto archive = std::make_shared<ChatArchive>(20'000);
    std::vector<std::unique_ptr<ChatLog>> logs(4);
    for (auto& log : logs) log = std::make_unique<ChatLog>(archive);
    for (int steps = *rc::gen::inRange(0, 300); steps > 0; --steps) {
      auto& log = logs.at(static_cast<std::size_t>(*rc::gen::inRange(0, 4)));
      if (*rc::gen::inRange(0, 40) == 0) log = std::make_unique<ChatLog>(archive);
      log->add(line(std::string(static_cast<std::size_t>(*rc::gen::inRange(1, 500)), 'x')));
      RC_ASSERT(archive->bytes() <= 20'000u);
    }
    for (const auto& log : logs) {
      const auto kept = numbers(*log);
      RC_ASSERT(kept.size() <= 100u);
      for (std::size_t i = 0; i < kept.size(); ++i)
        RC_ASSERT(kept[i] == log->last() - kept.size() + 1 + i);
    }
  }));
}

TEST(ChatArchive, ManyThreadsMayTalk) {
  const auto archive = std::make_shared<ChatArchive>(50'000);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([archive] {
      ChatLog log(archive);
      for (int i = 0; i < 500; ++i) log.add(line("hello"));
      EXPECT_EQ(log.last(), 500u);
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(archive->bytes(), 0u);
}

}  // namespace
}  // namespace earthwork::room
