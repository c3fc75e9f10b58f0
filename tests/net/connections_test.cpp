// The list of open connections.
#include "server/net/connections.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

TEST(Connections, AreCounted) {
  Connections connections;
  const auto a = connections.add([] {});
  const auto b = connections.add([] {});
  EXPECT_EQ(connections.count(), 2u);
  connections.replace(a, [] {});
  EXPECT_EQ(connections.count(), 2u);
  connections.remove(a);
  connections.remove(b);
  EXPECT_EQ(connections.count(), 0u);
}

TEST(Connections, AreAllToldToEnd) {
  Connections connections;
  int stopped = 0;
  connections.add([&] { stopped += 1; });
  const auto changed = connections.add([&] { stopped += 100; });
  connections.replace(changed, [&] { stopped += 10; });
  connections.stop_all(0ms);
  EXPECT_EQ(stopped, 11);
}

TEST(Connections, ThatComeAfterTheEndAreToldAtOnce) {
  Connections connections;
  connections.stop_all(0ms);
  bool stopped = false;
  connections.add([&] { stopped = true; });
  EXPECT_TRUE(stopped);
}

TEST(Connections, AreWaitedForButNotForEver) {
  Connections connections;
  const auto id = connections.add([] {});
  const auto start = std::chrono::steady_clock::now();
  connections.stop_all(30ms);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 30ms);

  std::thread leaving([&] { connections.remove(id); });
  connections.stop_all(10s);
  leaving.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

}  // namespace
}  // namespace earthwork::net
