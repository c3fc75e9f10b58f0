// Eight lines in ten seconds, whatever the clock does.
#include "server/net/chat_rate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <vector>

namespace earthwork::net {
namespace {

using Wait = std::optional<std::int64_t>;

TEST(ChatRate, TakesEightLinesAndThenSaysHowLongToWait) {
  ChatRate rate;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(rate.take(1000 + i), Wait{});
  EXPECT_EQ(rate.take(1008), Wait{9992});
  EXPECT_EQ(rate.take(6000), Wait{5000});
  EXPECT_EQ(rate.take(10'999), Wait{1});
  EXPECT_EQ(rate.take(11'000), Wait{});   // the first one's time is over,
  EXPECT_EQ(rate.take(11'000), Wait{1});  // and the second one's is not
  EXPECT_EQ(rate.take(11'001), Wait{});
}

TEST(ChatRate, ARefusedLineCostsNothing) {
  ChatRate rate;
  for (int i = 0; i < 8; ++i) ASSERT_EQ(rate.take(0), Wait{});
  for (int i = 0; i < 100; ++i) EXPECT_EQ(rate.take(5000), Wait{5000});
  for (int i = 0; i < 8; ++i) EXPECT_EQ(rate.take(10'000), Wait{});
  EXPECT_EQ(rate.take(10'000), Wait{10'000});
}

TEST(ChatRate, AClockThatWasSetBackSilencesNobody) {
  ChatRate rate;
  for (int i = 0; i < 8; ++i) ASSERT_EQ(rate.take(3'600'000), Wait{});
  EXPECT_EQ(rate.take(0), Wait{});
}

/// Whenever lines come: no ten seconds have more than eight, and who waits as told may speak.
TEST(ChatRate, HoldsInEveryTenSeconds) {
  EXPECT_TRUE(rc::check([] {
    ChatRate rate;
    std::vector<std::int64_t> said;
    std::int64_t now_ms = 0;
    for (int steps = *rc::gen::inRange(0, 200); steps > 0; --steps) {
      now_ms += *rc::gen::inRange(0, 3000);
      if (const Wait wait = rate.take(now_ms)) {
        RC_ASSERT(*wait >= 1 && *wait <= 10'000);
        now_ms += *wait;
        RC_ASSERT(!rate.take(now_ms));
      }
      said.push_back(now_ms);
    }
    for (std::size_t i = 8; i < said.size(); ++i) RC_ASSERT(said[i] - said[i - 8] >= 10'000);
  }));
}

}  // namespace
}  // namespace earthwork::net
