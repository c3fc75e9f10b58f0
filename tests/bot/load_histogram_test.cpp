// Percentiles of times that are counted, not kept.
#include "client/bot/load_histogram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr double kMaxError = 0.004;

TEST(Histogram, HasNoPercentilesOfNothing) {
  EXPECT_EQ(Histogram().percentile_ms(50), std::nullopt);
  EXPECT_EQ(Histogram().count(), 0u);
}

TEST(Histogram, TakesTheNearestRank) {
  Histogram times;
  for (int i = 1; i <= 1000; ++i) times.add(i * 1ms);
  EXPECT_EQ(times.count(), 1000u);
  EXPECT_NEAR(*times.percentile_ms(50), 500, 2);
  EXPECT_NEAR(*times.percentile_ms(99), 990, 4);
  EXPECT_NEAR(*times.percentile_ms(99.9), 999, 4);
  EXPECT_NEAR(*times.percentile_ms(100), 1000, 4);
  EXPECT_NEAR(*times.percentile_ms(0.001), 1, 0.004);
}

TEST(Histogram, IsExactBelowAQuarterOfAMicrosecond) {
  for (const int time_ns : {0, 1, 127, 128, 255}) {
    Histogram times;
    times.add(nanoseconds(time_ns));
    EXPECT_DOUBLE_EQ(*times.percentile_ms(50), time_ns / 1e6);
  }
}

TEST(Histogram, HoldsWhatIsBeyondItsEndsAtItsEnds) {
  Histogram times;
  times.add(-5s);
  EXPECT_EQ(times.percentile_ms(100), 0.0);
  times.add(nanoseconds::max());
  EXPECT_NEAR(*times.percentile_ms(100), std::ldexp(1e-6, 42), std::ldexp(1e-6, 34));
}

RC_GTEST_PROP(Histogram, IsNearTheSampleOfThatRank, (std::vector<std::uint32_t> samples)) {
  RC_PRE(!samples.empty());
  Histogram times;
  for (const std::uint32_t sample : samples) times.add(nanoseconds(sample));
  std::sort(samples.begin(), samples.end());
  for (const int percent : {1, 25, 50, 99, 100}) {
    const auto rank = (static_cast<std::size_t>(percent) * samples.size() + 99) / 100;
    const double exact_ms = samples[rank - 1] / 1e6;
    RC_ASSERT(std::abs(*times.percentile_ms(percent) - exact_ms) <= exact_ms * kMaxError);
  }
}

RC_GTEST_PROP(Histogram, AddedUpIsThatOfAllSamples,
              (const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b)) {
  Histogram first, second, both;
  for (const auto sample : a) first.add(nanoseconds(sample)), both.add(nanoseconds(sample));
  for (const auto sample : b) second.add(nanoseconds(sample)), both.add(nanoseconds(sample));
  first.add(second);
  RC_ASSERT(first.count() == a.size() + b.size());
  for (const int percent : {1, 50, 90, 100})
    RC_ASSERT(first.percentile_ms(percent) == both.percentile_ms(percent));
}

}  // namespace
}  // namespace earthwork::bot
