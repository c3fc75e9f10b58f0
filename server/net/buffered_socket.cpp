#include "server/net/buffered_socket.hpp"

#include <cassert>

namespace earthwork::net {

BufferedSocket::BufferedSocket(boost::asio::ip::tcp::socket socket)
    : socket_(std::move(socket)), flushed_(socket_.get_executor(), Clock::time_point::max()) {
  Error ignored;
  socket_.non_blocking(true, ignored);
}

BufferedSocket::Error BufferedSocket::send(std::string_view bytes) {
  assert(flushed());
  Error error;
  keep(bytes.substr(write(bytes, error)));
  return error;
}

BufferedSocket::Error BufferedSocket::flush() {
  Error error;
  if (flushed()) return error;
  left_ += write(std::string_view(waiting_).substr(left_), error);
  if (!flushed()) return error;
  std::string().swap(waiting_);
  left_ = 0;
  ++flushes_;
  flushed_.cancel();
  return error;
}

std::size_t BufferedSocket::write(std::string_view bytes, Error& error) {
  if (bytes.empty()) return 0;
  const std::size_t count = socket_.write_some(boost::asio::buffer(bytes), error);
  if (count > 0) last_byte_ = Clock::now();
  if (error == boost::asio::error::would_block || error == boost::asio::error::try_again)
    error.clear();
  return count;
}

BufferedSocket::Error BufferedSocket::send_ping(std::string_view ping) {
  assert(flushed());
  const Clock::time_point before = last_byte_;
  const Error error = send(ping);
  last_byte_ = before;
  return error;
}

void BufferedSocket::keep(std::string_view bytes) {
  if (bytes.empty()) return;
  // Exactly what is needed: a viewer that does not read keeps it for long.
  waiting_.reserve(waiting_.size() + bytes.size());
  waiting_ += bytes;
}

void BufferedSocket::close() {
  Error ignored;
  socket_.close(ignored);
  flushed_.cancel();
}

}  // namespace earthwork::net
