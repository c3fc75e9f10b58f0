// Strands: tasks in order and one at a time, by hand and on threads alike.
#include "server/room/strand.hpp"

#include <gtest/gtest.h>

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/room/asio_strand.hpp"
#include "server/room/entropy.hpp"
#include "server/room/manual_context.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;

TEST(ManualContext, RunsTasksInOrderAndThoseTheyPost) {
  ManualContext context;
  const auto strand = context.make_strand(), other = context.make_strand();
  std::vector<int> ran;
  strand->post([&] {
    ran.push_back(1);
    strand->post([&] { ran.push_back(3); });
  });
  other->post([&] { ran.push_back(2); });
  EXPECT_TRUE(ran.empty());
  EXPECT_EQ(context.run(), 3);
  EXPECT_EQ(ran, (std::vector<int>{1, 2, 3}));
}

TEST(ManualContext, LetsTimePassStepByStep) {
  ManualContext context;
  const auto strand = context.make_strand();
  std::vector<std::int64_t> at;
  strand->post_after(20ms, [&] { at.push_back(strand->now_ms()); });
  strand->post_after(10ms, [&] {
    at.push_back(strand->now_ms());
    strand->post_after(5ms, [&] { at.push_back(strand->now_ms()); });
  });
  context.advance(19ms);
  EXPECT_EQ(at, (std::vector<std::int64_t>{10, 15}));
  context.advance(1ms);
  EXPECT_EQ(at.back(), 20);
  EXPECT_EQ(strand->now_ms(), 20);
}

TEST(ManualContext, LetsGoOfTasksThatNeverRan) {
  const auto kept = std::make_shared<int>(7);
  {
    ManualContext context;
    context.make_strand()->post([kept] {});
    context.make_strand()->post_after(1s, [kept] {});
    EXPECT_EQ(kept.use_count(), 3);
  }
  EXPECT_EQ(kept.use_count(), 1);
}

TEST(AsioStrand, RunsOneTaskAtATimeInOrder) {
  boost::asio::thread_pool pool(4);
  const auto strand = make_asio_strand(pool.get_executor());
  std::vector<int> ran;  // unguarded: the strand is what guards it
  for (int i = 0; i < 1000; ++i) strand->post([&ran, i] { ran.push_back(i); });
  pool.join();
  ASSERT_EQ(ran.size(), 1000u);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(ran[static_cast<std::size_t>(i)], i);
}

TEST(ManualContext, RunsSoManyTasksAndNoMore) {
  ManualContext context;
  const auto strand = context.make_strand();
  std::vector<int> ran;
  for (int i = 0; i < 5; ++i) strand->post([&ran, i] { ran.push_back(i); });
  EXPECT_EQ(context.run(2), 2);
  EXPECT_EQ(ran, (std::vector<int>{0, 1}));
  EXPECT_EQ(context.run(), 3);
}

TEST(ManualContext, RunsWhatIsPostedAsideToo) {
  ManualContext context;
  const auto strand = context.make_strand();
  int ran = 0;
  strand->post_aside([&] { ++ran; });
  EXPECT_EQ(ran, 0);
  EXPECT_EQ(context.run(), 1);
  EXPECT_EQ(ran, 1);
}

TEST(AsioStrand, RunsWhatIsPostedAsideBesideItsTasks) {
  boost::asio::thread_pool pool(2);
  const auto strand = make_asio_strand(pool.get_executor());
  std::promise<void> told;
  bool heard = false;
  // Would wait for ever, were the other one of the strand's tasks.
  strand->post([&, future = std::make_shared<std::future<void>>(told.get_future())] {
    heard = future->wait_for(std::chrono::minutes(1)) == std::future_status::ready;
  });
  strand->post_aside([&] { told.set_value(); });
  pool.join();
  EXPECT_TRUE(heard);
}

TEST(AsioStrand, OverASerialExecutorKnowsNoOther) {
  boost::asio::thread_pool pool(2);
  const auto strand = wrap_serial_executor(boost::asio::make_strand(pool));
  std::vector<int> ran;  // unguarded
  for (int i = 0; i < 100; ++i) {
    strand->post([&ran, i] { ran.push_back(i); });
    strand->post_aside([&ran, i] { ran.push_back(-i); });
  }
  strand->post_aside([] { throw 7; });
  pool.join();
  EXPECT_EQ(ran.size(), 200u);
}

TEST(AsioStrand, WaitsAsLongAsItIsTold) {
  boost::asio::thread_pool pool(2);
  const auto strand = make_asio_strand(pool.get_executor());
  const auto start = std::chrono::steady_clock::now();
  auto end = start;
  strand->post_after(30ms, [&] { end = std::chrono::steady_clock::now(); });
  pool.join();
  EXPECT_GE(end - start, 30ms);
  EXPECT_GT(strand->now_ms(), 1'600'000'000'000);
}

TEST(AsioStrand, OutlivesATaskThatThrows) {
  boost::asio::thread_pool pool(2);
  const auto strand = make_asio_strand(pool.get_executor());
  int ran = 0;
  strand->post([] { throw std::runtime_error("on purpose"); });
  strand->post_after(1ms, [] { throw 7; });
  strand->post([&] { ++ran; });
  strand->post_after(20ms, [&] { ++ran; });
  pool.join();
  EXPECT_EQ(ran, 2);
}

TEST(ManualContext, GivesOutWhatATaskThrowsAndGoesOn) {
  ManualContext context;
  const auto strand = context.make_strand();
  strand->post([] { throw std::runtime_error("on purpose"); });
  strand->post([] {});
  EXPECT_THROW(context.run(), std::runtime_error);
  EXPECT_EQ(context.run(), 1);
}

TEST(Entropy, GivesKeysOf128Bits) {
  const std::string key = random_key();
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(key.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(key, random_key());
  EXPECT_NE(random_u64(), random_u64());
}

}  // namespace
}  // namespace earthwork::room
