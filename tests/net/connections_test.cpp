// The list of open connections.
#include "server/net/connections.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

Connections::Id add(Connections& connections, std::function<void()> stop) {
  const auto id = connections.admit(100).value();
  connections.on_stop(id, std::move(stop));
  return id;
}

TEST(Connections, AreCounted) {
  Connections connections;
  const auto a = add(connections, [] {});
  const auto b = add(connections, [] {});
  EXPECT_EQ(connections.count(), 2u);
  connections.on_stop(a, [] {});
  EXPECT_EQ(connections.count(), 2u);
  connections.remove(a);
  connections.remove(b);
  EXPECT_EQ(connections.count(), 0u);
}

TEST(Connections, AreNoMoreThanTheMost) {
  Connections connections;
  const auto a = connections.admit(2), b = connections.admit(2);
  ASSERT_TRUE(a && b);
  EXPECT_FALSE(connections.admit(2));
  connections.remove(*a);
  EXPECT_TRUE(connections.admit(2));
  EXPECT_FALSE(connections.admit(2));
}

TEST(Connections, AreAllToldToEnd) {
  Connections connections;
  int stopped = 0;
  add(connections, [&] { stopped += 1; });
  const auto changed = add(connections, [&] { stopped += 100; });
  connections.on_stop(changed, [&] { stopped += 10; });
  connections.stop_all(0ms);
  EXPECT_EQ(stopped, 11);
}

TEST(Connections, ThatComeAfterTheEndAreToldAtOnce) {
  Connections connections;
  connections.stop_all(0ms);
  bool stopped = false;
  add(connections, [&] { stopped = true; });
  EXPECT_TRUE(stopped);
}

TEST(Connections, AreWaitedForButNotForEver) {
  Connections connections;
  const auto id = add(connections, [] {});
  const auto start = std::chrono::steady_clock::now();
  connections.stop_all(30ms);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 30ms);

  std::thread leaving([&] { connections.remove(id); });
  connections.stop_all(60s);
  leaving.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
}

}  // namespace
}  // namespace earthwork::net
