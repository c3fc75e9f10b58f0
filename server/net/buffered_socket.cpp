#include "server/net/buffered_socket.hpp"

#include <cassert>

namespace earthwork::net {

BufferedSocket::BufferedSocket(boost::asio::ip::tcp::socket socket)
    : socket_(std::move(socket)), flushed_(socket_.get_executor(), Clock::time_point::max()) {
  Error ignored;
  socket_.non_blocking(true, ignored);
}

BufferedSocket::Error BufferedSocket::send(std::string_view bytes) {
  Error error;
  if (!flushed()) {
    const std::string_view before = std::string_view(waiting_).substr(left_);
    const std::size_t sent = socket_.write_some(boost::asio::buffer(before), error);
    take_back(sent);
  }
  std::size_t sent = 0;
  if (flushed() && !error && !bytes.empty()) {
    sent = socket_.write_some(boost::asio::buffer(bytes), error);
    if (sent > 0) last_byte_ = Clock::now();
  }
  keep(bytes.substr(sent));
  if (error == boost::asio::error::would_block || error == boost::asio::error::try_again)
    error.clear();
  return error;
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

void BufferedSocket::take_back(std::size_t bytes) {
  if (bytes == 0) return;
  last_byte_ = Clock::now();
  left_ += bytes;
  if (!flushed()) return;
  std::string().swap(waiting_);
  left_ = 0;
  flushed_.cancel();
}

void BufferedSocket::close() {
  Error ignored;
  socket_.close(ignored);
  flushed_.cancel();
}

}  // namespace earthwork::net
