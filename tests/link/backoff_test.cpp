// Delays double from a quarter of a second to half a minute, each with its jitter.
#include "client/link/backoff.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace earthwork::link {
namespace {

using namespace std::chrono_literals;

RC_GTEST_PROP(Backoff, DoublesFromAQuarterOfASecondToHalfAMinute, (std::uint64_t seed)) {
  Backoff backoff(seed);
  for (const auto d : {250ms, 500ms, 1000ms, 2000ms, 4000ms, 8000ms, 16000ms, 30000ms, 30000ms}) {
    const auto delay = backoff.next();
    RC_ASSERT(delay >= d / 2);
    RC_ASSERT(delay <= d);
  }
  backoff.restart();
  RC_ASSERT(backoff.next() <= 250ms);
}

TEST(Backoff, GivesEverybodyAnotherDelay) {
  std::set<std::chrono::milliseconds> delays;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Backoff backoff(seed);
    for (int i = 0; i < 6; ++i) static_cast<void>(backoff.next());
    delays.insert(backoff.next());  // of 8,001
  }
  EXPECT_GT(delays.size(), 90u);
}

TEST(Backoff, WaitsAsLongAsTheServerAsks) {
  Backoff backoff(1);
  for (int i = 0; i < 20; ++i) {
    const auto delay = backoff.next(60'000ms);
    EXPECT_GE(delay, 60'000ms);
    EXPECT_LE(delay, 90'000ms);
  }
  backoff.restart();
  const auto first = backoff.next(10ms);
  EXPECT_GE(first, 125ms);
  EXPECT_LE(first, 250ms);
}

TEST(Backoff, WaitsAnHourAndAHalfAtMost) {
  Backoff backoff(2);
  EXPECT_LE(backoff.next(std::chrono::milliseconds(UINT32_MAX)), 5'400'000ms);
  EXPECT_GE(backoff.next(std::chrono::milliseconds(UINT32_MAX)), 3'600'000ms);
}

}  // namespace
}  // namespace earthwork::link
