// The loop: timers in their order, cancelled ones not at all, signals instead of death.
#include "client/link/event_loop.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <string>

namespace earthwork::link {
namespace {

using namespace std::chrono_literals;

TEST(EventLoop, EndsWhenNothingIsLeft) {
  EventLoop loop;
  loop.run();
  SUCCEED();
}

TEST(EventLoop, CallsTimersInTheirOrder) {
  EventLoop loop;
  std::string order;
  Timer late(loop), early(loop);
  late.start(300ms, [&] { order += "late "; });
  early.start(1ms, [&] { order += "early "; });
  loop.run();
  EXPECT_EQ(order, "early late ");
}

TEST(EventLoop, MayBeRunAgainAfterAStop) {
  EventLoop loop;
  int calls = 0;
  Timer timer(loop), never(loop);
  never.start(1h, [&] { calls += 100; });
  timer.start(1ms, [&] { ++calls, loop.stop(); });
  loop.run();
  timer.start(1ms, [&] { ++calls, loop.stop(); });
  loop.run();
  EXPECT_EQ(calls, 2);
}

TEST(Timer, IsNotCalledOnceCancelledEvenWhenItsTimeHasCome) {
  EventLoop loop;
  bool called = false;
  Timer canceller(loop), cancelled(loop);
  canceller.start(0ms, [&] { cancelled.cancel(); });
  cancelled.start(0ms, [&] { called = true; });
  loop.run();
  EXPECT_FALSE(called);
}

TEST(Timer, StartedAgainForgetsWhatWasSet) {
  EventLoop loop;
  std::string calls;
  Timer timer(loop);
  timer.start(1h, [&] { calls += "first "; });
  timer.start(1ms, [&] { calls += "second "; });
  loop.run();
  EXPECT_EQ(calls, "second ");
}

TEST(Timer, MayStartItselfAgain) {
  EventLoop loop;
  int calls = 0;
  Timer timer(loop);
  std::function<void()> tick = [&] {
    if (++calls < 3) timer.start(1ms, tick);
  };
  timer.start(1ms, tick);
  loop.run();
  EXPECT_EQ(calls, 3);
}

TEST(Timer, CancelsWhenItGoes) {
  EventLoop loop;
  bool called = false;
  {
    Timer(loop).start(1ms, [&] { called = true; });
  }
  loop.run();
  EXPECT_FALSE(called);
}

TEST(SignalWatch, CallsBackForEachSignal) {
  EventLoop loop;
  int calls = 0;
  const SignalWatch watch(loop, [&] {
    if (++calls == 2) return loop.stop();
    std::raise(SIGINT);
  });
  Timer start(loop);
  start.start(1ms, [] { std::raise(SIGTERM); });
  loop.run();
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace earthwork::link
