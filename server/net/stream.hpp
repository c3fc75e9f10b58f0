/// The TCP stream of a connection, which knows when a byte last went through. Only for the files
/// that speak Beast.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <chrono>
#include <cstddef>
#include <limits>

namespace earthwork::net {

/// A rate policy that limits nothing, but is told of every transfer, parts of messages included.
class ActivityPolicy {
 public:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] Clock::time_point last_byte() const { return last_byte_; }
  /// Whether written bytes count; received ones always do.
  void count_written(bool count) { count_written_ = count; }

 private:
  friend class boost::beast::rate_policy_access;

  static std::size_t available_read_bytes() { return std::numeric_limits<std::size_t>::max(); }
  static std::size_t available_write_bytes() { return std::numeric_limits<std::size_t>::max(); }
  void transfer_read_bytes(std::size_t n) {
    if (n > 0) last_byte_ = Clock::now();
  }
  void transfer_write_bytes(std::size_t n) {
    if (n > 0 && count_written_) last_byte_ = Clock::now();
  }
  static void on_timer() {}

  Clock::time_point last_byte_ = Clock::now();
  bool count_written_ = true;
};

using Stream =
    boost::beast::basic_stream<boost::asio::ip::tcp, boost::asio::any_io_executor, ActivityPolicy>;

}  // namespace earthwork::net
