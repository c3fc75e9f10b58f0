// Workers: jobs in turn, a bound on what waits, an end that does not wait for all of it.
#include "server/net/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>

namespace earthwork::net {
namespace {

TEST(Workers, DoWhatTheyAreOffered) {
  Workers workers(2);
  std::promise<int> done;
  ASSERT_TRUE(workers.offer([&] { done.set_value(7); }));
  EXPECT_EQ(done.get_future().get(), 7);
}

TEST(Workers, RefuseMoreThanMayWait) {
  std::promise<void> running, go_on;
  std::atomic<int> ran{0};
  {
    Workers workers(1);
    ASSERT_TRUE(workers.offer([&] {
      running.set_value();
      go_on.get_future().wait();
    }));
    running.get_future().wait();
    for (std::size_t i = 0; i < kMaxWaitingJobs; ++i) {
      EXPECT_FALSE(workers.full()) << i;
      ASSERT_TRUE(workers.offer([&] { ++ran; })) << i;
    }
    EXPECT_TRUE(workers.full());
    EXPECT_FALSE(workers.offer([&] { ++ran; }));
    go_on.set_value();
    std::promise<void> last;
    while (!workers.offer([&] { last.set_value(); })) std::this_thread::yield();
    last.get_future().wait();
  }
  EXPECT_EQ(ran, static_cast<int>(kMaxWaitingJobs));
}

TEST(Workers, OutliveAJobThatThrows) {
  Workers workers(1);
  std::promise<int> done;
  ASSERT_TRUE(workers.offer([] { throw std::runtime_error("on purpose"); }));
  ASSERT_TRUE(workers.offer([&] { done.set_value(7); }));
  EXPECT_EQ(done.get_future().get(), 7);
}

TEST(Workers, DropWhatWaitsAtTheEnd) {
  std::promise<void> running, go_on;
  std::atomic<bool> ran{false};
  auto held = std::make_shared<int>(7);
  const std::weak_ptr<int> waiting = held;
  auto workers = std::make_unique<Workers>(1);
  ASSERT_TRUE(workers->offer([&] {
    running.set_value();
    go_on.get_future().wait();
  }));
  running.get_future().wait();
  ASSERT_TRUE(workers->offer([&ran, kept = std::move(held)] { ran = true; }));
  std::thread ending([&] { workers.reset(); });
  // The running job may finish once the waiting one was let go of.
  while (!waiting.expired()) std::this_thread::yield();
  go_on.set_value();
  ending.join();
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace earthwork::net
