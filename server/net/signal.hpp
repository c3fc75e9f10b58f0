/// Lets one coroutine wait until another one of its strand says that something has changed.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <utility>

namespace earthwork::net {

/// One strand, one waiter. It checks its condition before each wait, so a notice without a waiter
/// is not lost; it costs nothing either.
class Signal {
 public:
  explicit Signal(const boost::asio::any_io_executor& executor)
      : timer_(executor, boost::asio::steady_timer::time_point::max()) {}

  /// Comes back after `notify`, or when the coroutine is cancelled.
  boost::asio::awaitable<void> wait() {
    waiting_ = true;
    co_await timer_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
    waiting_ = false;
  }
  void notify() {
    if (std::exchange(waiting_, false)) timer_.cancel();
  }

 private:
  boost::asio::steady_timer timer_;
  bool waiting_ = false;
};

}  // namespace earthwork::net
