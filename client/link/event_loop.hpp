/// The loop that a client's connections, timers and signals run on, so that the programs need no
/// Asio of their own.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

namespace boost::asio {
class io_context;
}

namespace earthwork::link {

/// One thread at a time: what is called back is called inside `run`, on its thread. Any number of
/// links and timers may share a loop; they must not outlive it.
class EventLoop {
 public:
  EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;
  ~EventLoop();

  /// Calls back until `stop`, or until nothing is left that could happen. May be run again.
  void run();
  /// Makes `run` return after the current callback.
  void stop();

  boost::asio::io_context& context() { return *context_; }

 private:
  std::unique_ptr<boost::asio::io_context> context_;
};

/// Calls back once after a while.
class Timer {
 public:
  explicit Timer(EventLoop& loop);
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  /// Cancels.
  ~Timer();

  /// Calls `then` in `delay` from now, out of `EventLoop::run`; what was set before is cancelled.
  void start(std::chrono::nanoseconds delay, std::function<void()> then);
  /// What was set is not called any more, and does not keep the loop running.
  void cancel();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// While it lives, SIGINT and SIGTERM do not end the process but call back, each time. Its wait
/// alone keeps `EventLoop::run` going. One at a time in a process.
class SignalWatch {
 public:
  SignalWatch(EventLoop& loop, std::function<void()> then);
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;
  ~SignalWatch();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace earthwork::link
