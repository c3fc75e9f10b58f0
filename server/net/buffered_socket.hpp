/// A TCP socket whose writes go to memory first, so that whoever frames messages and whoever
/// answers pings write whole frames into one stream, and many of them leave in one call.
///
/// It is a next layer of Beast's WebSocket stream. Beast reads through it, and writes what is
/// Beast's own (handshake, pongs, close) by `async_write_some`: all bytes are taken at once, so
/// that frames stay whole, and the operation ends when they have left, so that a peer that does not
/// read cannot make it answer without end. Messages are given to `send`.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace earthwork::net {

/// One strand, the socket's executor.
class BufferedSocket {
 public:
  using Clock = std::chrono::steady_clock;
  using Error = boost::beast::error_code;
  using executor_type = boost::asio::any_io_executor;

  explicit BufferedSocket(boost::asio::ip::tcp::socket socket);

  executor_type get_executor() { return socket_.get_executor(); }
  boost::asio::ip::tcp::socket& socket() { return socket_; }
  /// `flush` is to be called soon: something was written that waits.
  void on_output(std::function<void()> notice) { on_output_ = std::move(notice); }

  /// Nothing waits to leave.
  [[nodiscard]] bool flushed() const { return left_ == waiting_.size(); }
  /// Sends what the socket takes now of `bytes`; the rest waits. Only when nothing waits.
  [[nodiscard]] Error send(std::string_view bytes);
  /// Sends what the socket takes now of what waits.
  [[nodiscard]] Error flush();
  /// A ping: its leaving is no sign of life, only the answer to it is. Only when nothing waits.
  [[nodiscard]] Error send_ping(std::string_view ping);
  /// `handler(error)` when the socket takes more.
  template <class Handler>
  void async_wait_writable(Handler handler) {
    socket_.async_wait(boost::asio::ip::tcp::socket::wait_write, std::move(handler));
  }
  /// Ends all operations.
  void close();

  /// When a byte was received or sent last.
  [[nodiscard]] Clock::time_point last_byte() const { return last_byte_; }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token);
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token);

 private:
  void keep(std::string_view bytes);
  [[nodiscard]] std::size_t write(std::string_view bytes, Error& error);

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer flushed_;  // never due; cancelled when all that waited has left
  std::function<void()> on_output_ = [] {};
  std::string waiting_;
  std::size_t left_ = 0;       // of waiting_, which is empty when all has
  std::uint64_t flushes_ = 0;  // how often all that waited has left
  Clock::time_point last_byte_ = Clock::now();
};

template <class Buffers, class Token>
auto BufferedSocket::async_read_some(const Buffers& buffers, Token&& token) {
  return boost::asio::async_compose<Token, void(Error, std::size_t)>(
      [this, buffers, started = false](auto& self, Error error = {},
                                       std::size_t bytes = 0) mutable {
        if (!std::exchange(started, true)) {
          const Buffers into = buffers;
          return socket_.async_read_some(into, std::move(self));
        }
        if (bytes > 0) last_byte_ = Clock::now();
        self.complete(error, bytes);
      },
      token, socket_);
}

template <class Buffers, class Token>
auto BufferedSocket::async_write_some(const Buffers& buffers, Token&& token) {
  return boost::asio::async_compose<Token, void(Error, std::size_t)>(
      [this, buffers, started = false, before = std::uint64_t{0}](auto& self, Error = {}) mutable {
        if (!std::exchange(started, true)) {
          before = flushes_;
          for (auto part = boost::asio::buffer_sequence_begin(buffers);
               part != boost::asio::buffer_sequence_end(buffers); ++part) {
            const boost::asio::const_buffer bytes(*part);
            keep({static_cast<const char*>(bytes.data()), bytes.size()});
          }
          on_output_();
          return flushed_.async_wait(std::move(self));
        }
        // Something newer may wait again by now.
        if (flushes_ == before) return self.complete(boost::asio::error::operation_aborted, 0);
        self.complete({}, boost::asio::buffer_size(buffers));
      },
      token, socket_);
}

/// How Beast ends a connection after both sides have said close.
template <class Handler>
void async_teardown(boost::beast::role_type role, BufferedSocket& socket, Handler&& handler) {
  boost::beast::websocket::async_teardown(role, socket.socket(), std::forward<Handler>(handler));
}
/// How Beast ends a connection that took too long.
inline void beast_close_socket(BufferedSocket& socket) { socket.close(); }

}  // namespace earthwork::net
