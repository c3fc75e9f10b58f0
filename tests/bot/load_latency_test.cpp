// Sending times and pictures, brought together by seq.
#include "client/bot/load_latency.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using Time = LoadClock::time_point;

Time at(std::chrono::nanoseconds since) { return Time(1h) + since; }

TEST(SendTimes, KnowWhatTheyWereTold) {
  SendTimes times;
  EXPECT_EQ(times.sent(1), std::nullopt);
  times.tell(1, at(5ms));
  EXPECT_EQ(times.sent(1), at(5ms));
  EXPECT_EQ(times.sent(2), std::nullopt);
}

TEST(SendTimes, ForgetAfterAMillion) {
  SendTimes times;
  times.tell(3, at(1ms));
  times.tell(3 + (1 << 20), at(2ms));
  EXPECT_EQ(times.sent(3), std::nullopt);
  EXPECT_EQ(times.sent(3 + (1 << 20)), at(2ms));
}

TEST(SendTimes, AreReadWhileTheyAreTold) {
  SendTimes times;
  constexpr std::uint64_t kCount = 100'000;
  std::thread teller([&] {
    for (std::uint64_t seq = 1; seq <= kCount; ++seq)
      times.tell(seq, at(std::chrono::nanoseconds(seq)));
  });
  for (std::uint64_t seq = 1; seq <= kCount;)
    if (const auto sent = times.sent(seq)) {
      ASSERT_EQ(*sent, at(std::chrono::nanoseconds(seq)));
      ++seq;
    }
  teller.join();
}

class Pictures : public testing::Test {
 protected:
  void match(std::chrono::nanoseconds now) { pictures_.match(times_, at(now), out_); }

  SendTimes times_;
  PictureTimes pictures_;
  Histogram out_;
};

TEST_F(Pictures, GiveEveryEditTheTimeToTheFirstPictureWithIt) {
  for (std::uint64_t seq = 1; seq <= 4; ++seq) times_.tell(seq, at(seq * 1ms));
  pictures_.shown(3, at(10ms));
  pictures_.shown(3, at(11ms));
  pictures_.shown(4, at(20ms));
  match(20ms);
  EXPECT_EQ(out_.count(), 4u);  // 9, 8, 7 and 16 ms
  EXPECT_NEAR(*out_.percentile_ms(25), 7, 0.03);
  EXPECT_NEAR(*out_.percentile_ms(75), 9, 0.04);
  EXPECT_NEAR(*out_.percentile_ms(100), 16, 0.07);
}

TEST_F(Pictures, DoNotCountWhatWasThereBefore) {
  for (std::uint64_t seq = 1; seq <= 4; ++seq) times_.tell(seq, at(0ms));
  pictures_.begin(3);
  pictures_.shown(3, at(1ms));
  pictures_.shown(4, at(2ms));
  match(3ms);
  EXPECT_EQ(out_.count(), 1u);
}

TEST_F(Pictures, WaitForAnEditThatIsAnsweredAfterItIsShown) {
  times_.tell(1, at(0ms));
  pictures_.shown(2, at(4ms));
  match(5ms);
  EXPECT_EQ(out_.count(), 1u);
  times_.tell(2, at(1ms));
  match(6ms);
  EXPECT_EQ(out_.count(), 2u);
  EXPECT_NEAR(*out_.percentile_ms(50), 3, 0.02);
}

TEST_F(Pictures, LeaveOutAnEditOfSomebodyElseWhenTheirPatienceEnds) {
  times_.tell(3, at(0ms));
  pictures_.shown(3, at(4ms));
  match(PictureTimes::kMatchPatience);
  EXPECT_EQ(out_.count(), 0u);
  match(PictureTimes::kMatchPatience + 4ms);
  EXPECT_EQ(out_.count(), 1u);
}

}  // namespace
}  // namespace earthwork::bot
