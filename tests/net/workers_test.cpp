// Workers: jobs in turn, a bound on what waits, an end that does not wait for all of it.
#include "server/net/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

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
    for (std::size_t i = 0; i < kMaxWaitingJobs; ++i)
      ASSERT_TRUE(workers.offer([&] { ++ran; })) << i;
    EXPECT_FALSE(workers.offer([&] { ++ran; }));
    go_on.set_value();
    std::promise<void> last;
    while (!workers.offer([&] { last.set_value(); })) std::this_thread::yield();
    last.get_future().wait();
  }
  EXPECT_EQ(ran, static_cast<int>(kMaxWaitingJobs));
}

TEST(Workers, DropWhatWaitsAtTheEnd) {
  std::promise<void> running, go_on;
  std::atomic<bool> ran{false};
  auto workers = std::make_unique<Workers>(1);
  ASSERT_TRUE(workers->offer([&] {
    running.set_value();
    go_on.get_future().wait();
  }));
  running.get_future().wait();
  ASSERT_TRUE(workers->offer([&] { ran = true; }));
  std::thread ending([&] { workers.reset(); });
  // Refused from the moment on that the end began; only then may the running job finish.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  go_on.set_value();
  ending.join();
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace earthwork::net
