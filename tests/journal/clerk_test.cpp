// Clerks: what is posted runs once, urgent tasks first, and nothing is left at the end.
#include "server/journal/clerk.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/journal/memory_journal.hpp"

namespace earthwork::journal {
namespace {

std::unique_ptr<Journal> empty_journal() { return make_memory_journal({}); }

history::Event first_event() {
  protocol::Edit edit;
  edit.path = {{1, 2}};
  return {.seq = 1, .time_ms = 5, .author = 7, .id = 1, .action = edit, .hash = 9};
}

TEST(Clerk, RunsUrgentTasksBeforeIdleOnesAndKeepsTheOrderOfEach) {
  std::string order;
  std::promise<void> begun, filled;
  {
    const auto clerk = hire_clerk(empty_journal());
    clerk->post(Urgency::now, [&](Journal&) {
      begun.set_value();
      filled.get_future().wait();
    });
    begun.get_future().wait();
    for (const char* idle : {"a", "b", "c"})
      clerk->post(Urgency::idle, [&order, idle](Journal&) { order += idle; });
    for (const char* now : {"1", "2", "3"})
      clerk->post(Urgency::now, [&order, now](Journal&) { order += now; });
    filled.set_value();
  }
  EXPECT_EQ(order, "123abc");
}

TEST(Clerk, LetsAnUrgentTaskInBetweenIdleOnes) {
  std::string order;
  {
    const auto clerk = hire_clerk(empty_journal());
    clerk->post(Urgency::idle, [&](Journal&) {
      order += "a";
      clerk->post(Urgency::idle, [&](Journal&) { order += "b"; });
      clerk->post(Urgency::now, [&](Journal&) { order += "1"; });
    });
  }
  EXPECT_EQ(order, "a1b");
}

TEST(Clerk, WorksBesideWhoeverPosts) {
  const auto clerk = hire_clerk(empty_journal());
  std::promise<std::thread::id> worker;
  clerk->post(Urgency::now, [&](Journal&) { worker.set_value(std::this_thread::get_id()); });
  EXPECT_NE(worker.get_future().get(), std::this_thread::get_id());
}

TEST(Clerk, TakesTasksFromManyThreads) {
  int ran = 0;
  {
    const auto clerk = hire_clerk(empty_journal());
    std::vector<std::thread> posters;
    for (int i = 0; i < 4; ++i)
      posters.emplace_back([&] {
        for (int n = 0; n < 100; ++n) clerk->post(Urgency::now, [&ran](Journal&) { ++ran; });
      });
    for (std::thread& poster : posters) poster.join();
  }
  EXPECT_EQ(ran, 400);
}

TEST(Clerk, LetsGoOfATaskOnceItHasRun) {
  const auto held = std::make_shared<int>(1);
  const auto clerk = hire_clerk(empty_journal());
  clerk->post(Urgency::now, [held](Journal&) {});
  std::promise<void> after;
  clerk->post(Urgency::now, [&](Journal&) { after.set_value(); });
  after.get_future().wait();
  EXPECT_EQ(held.use_count(), 1);
}

TEST(Clerk, HandsItsJournalToEveryTask) {
  for (auto* hire : {&hire_clerk, &immediate_clerk}) {
    std::uint64_t seen = 0;
    {
      const auto clerk = hire(empty_journal());
      clerk->post(Urgency::now, [](Journal& journal) {
        ASSERT_TRUE(journal.append(0, std::vector{first_event()}));
      });
      clerk->post(Urgency::idle, [&](Journal& journal) { seen = journal.last_seq(); });
    }
    EXPECT_EQ(seen, 1u);
  }
}

TEST(ImmediateClerk, RunsATaskWithinTheCall) {
  const auto clerk = immediate_clerk(empty_journal());
  bool ran = false;
  clerk->post(Urgency::idle, [&](Journal&) { ran = true; });
  EXPECT_TRUE(ran);
}

}  // namespace
}  // namespace earthwork::journal
