// The token bucket.
#include "server/net/rate.hpp"

#include <gtest/gtest.h>

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

TEST(Rate, LetsABurstThroughAndThenHoldsBack) {
  const Rate::Clock::time_point start{};
  Rate rate(100, 5, start);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rate.take(start), 0ns) << i;
  EXPECT_NEAR(static_cast<double>(rate.take(start).count()), 10e6, 1);
  EXPECT_NEAR(static_cast<double>(rate.take(start).count()), 20e6, 1);
}

TEST(Rate, RefillsWithTime) {
  const Rate::Clock::time_point start{};
  Rate rate(100, 5, start);
  for (int i = 0; i < 5; ++i) rate.take(start);
  EXPECT_EQ(rate.take(start + 11ms), 0ns);
  EXPECT_GT(rate.take(start + 11ms), 0ns);
}

TEST(Rate, SavesUpNoMoreThanTheBurst) {
  const Rate::Clock::time_point start{};
  Rate rate(100, 3, start);
  const auto later = start + 1h;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rate.take(later), 0ns);
  EXPECT_GT(rate.take(later), 0ns);
}

TEST(Rate, OverTimeIsTheRate) {
  Rate::Clock::time_point now{};
  Rate rate(1000, 10, now);
  for (int i = 0; i < 1010; ++i) now += rate.take(now);
  EXPECT_NEAR(std::chrono::duration<double>(now.time_since_epoch()).count(), 1, 0.01);
}

}  // namespace
}  // namespace earthwork::net
