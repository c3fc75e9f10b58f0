// Tasks that take long: in turn, and a few at a time.
#include "server/room/aside_queue.hpp"

#include <gtest/gtest.h>

#include <new>
#include <string>
#include <vector>

namespace earthwork::room {
namespace {

TEST(AsideQueue, RunsAFewAtATimeInOrder) {
  std::vector<Strand::Task> given;
  const auto queue =
      std::make_shared<AsideQueue>([&](Strand::Task task) { given.push_back(std::move(task)); }, 2);
  std::string ran;
  for (const char* name : {"a", "b", "c", "d"}) queue->post([&ran, name] { ran += name; });
  ASSERT_EQ(given.size(), 2u);
  given[0]();
  EXPECT_EQ(ran, "a");
  ASSERT_EQ(given.size(), 3u);  // c may begin, for a has ended
  given[2]();
  given[1]();
  ASSERT_EQ(given.size(), 4u);
  given[3]();
  EXPECT_EQ(ran, "acbd");
}

TEST(AsideQueue, RunsWithinTheCallWhereTasksMay) {
  const auto queue = std::make_shared<AsideQueue>([](const Strand::Task& task) { task(); }, 1);
  std::string ran;
  queue->post([&] {
    ran += "outer(";
    queue->post([&] { ran += "inner"; });  // one at a time: after this one
    ran += ")";
  });
  EXPECT_EQ(ran, "outer()inner");
}

TEST(AsideQueue, GoesOnAfterATaskThatThrows) {
  const auto queue = std::make_shared<AsideQueue>([](const Strand::Task& task) { task(); }, 1);
  EXPECT_THROW(queue->post([] { throw std::bad_alloc(); }), std::bad_alloc);
  bool ran = false;
  queue->post([&] { ran = true; });
  EXPECT_TRUE(ran);
}

TEST(AsideQueue, GoesOnWhenNobodyElseHoldsIt) {
  std::vector<Strand::Task> given;
  auto queue =
      std::make_shared<AsideQueue>([&](Strand::Task task) { given.push_back(std::move(task)); }, 1);
  int ran = 0;
  queue->post([&] { ++ran; });
  queue->post([&] { ++ran; });
  queue.reset();
  given[0]();
  ASSERT_EQ(given.size(), 2u);
  given[1]();
  EXPECT_EQ(ran, 2);
}

}  // namespace
}  // namespace earthwork::room
