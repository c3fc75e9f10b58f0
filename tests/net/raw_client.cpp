#include "tests/net/raw_client.hpp"

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

namespace earthwork::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http_ns = beast::http;
using asio::ip::tcp;
using Error = beast::error_code;

constexpr std::chrono::minutes kPatience{1};

tcp::socket connected(asio::io_context& context, std::uint16_t port) {
  tcp::socket socket(context);
  socket.connect({asio::ip::make_address("127.0.0.1"), port});
  return socket;
}

std::string own_host(std::uint16_t port) { return "127.0.0.1:" + std::to_string(port); }

}  // namespace

struct TcpClient::Impl {
  asio::io_context context;
  tcp::socket socket;
  std::string ahead;  // read, and not given out yet
  explicit Impl(std::uint16_t port) : socket(connected(context, port)) {}
};

TcpClient::TcpClient(std::uint16_t port) : impl_(std::make_unique<Impl>(port)) {}
TcpClient::~TcpClient() = default;

std::uint16_t TcpClient::own_port() const { return impl_->socket.local_endpoint().port(); }

bool TcpClient::send(std::string_view bytes) {
  Error error;
  asio::write(impl_->socket, asio::buffer(bytes), error);
  return !error;
}

std::string TcpClient::read_until(const std::string& end) {
  std::string& bytes = impl_->ahead;
  std::optional<std::size_t> length;
  asio::async_read_until(impl_->socket, asio::dynamic_buffer(bytes), end,
                         [&](Error error, std::size_t n) { length = error ? bytes.size() : n; });
  impl_->context.restart();
  impl_->context.run_for(kPatience);
  if (!length) impl_->socket.cancel(), impl_->context.run();
  std::string head = bytes.substr(0, *length);
  bytes.erase(0, *length);
  return head;
}

std::string TcpClient::read_to_end(std::chrono::milliseconds patience, bool& closed) {
  std::string bytes = std::exchange(impl_->ahead, {});
  closed = false;
  asio::async_read(impl_->socket, asio::dynamic_buffer(bytes),
                   [&](Error, std::size_t) { closed = true; });
  impl_->context.restart();
  impl_->context.run_for(patience);
  const bool ended = closed;
  if (!closed) impl_->socket.cancel(), impl_->context.run();
  closed = ended;
  return bytes;
}

std::string handshake_text(std::string_view host) {
  return "GET /ws HTTP/1.1\r\nHost: " + std::string(host) +
         "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
         "Sec-WebSocket-Protocol: earthwork.v1\r\n\r\n";
}

std::string masked_text(std::string_view message) {
  std::string frame = "\x81";
  frame += static_cast<char>(0x80 | message.size());
  frame.append(4, '\0');
  return frame.append(message);
}

HttpAnswer http(std::uint16_t port, std::string_view request) {
  asio::io_context context;
  tcp::socket socket = connected(context, port);
  Error error;
  asio::write(socket, asio::buffer(request), error);
  beast::flat_buffer buffer;
  http_ns::response_parser<http_ns::string_body> parser;
  parser.body_limit(std::uint64_t{1} << 30);
  parser.skip(request.starts_with("HEAD "));
  std::optional<Error> done;
  http_ns::async_read(socket, buffer, parser, [&](Error e, std::size_t) { done = e; });
  context.run_for(kPatience);
  if (!done || *done) return {};

  HttpAnswer answer{
      .status = static_cast<int>(parser.get().result_int()), .headers = {}, .body = {}};
  for (const auto& field : parser.get())
    answer.headers[boost::to_lower_copy(std::string(field.name_string()))] = field.value();
  answer.body = parser.get().body();
  return answer;
}

HttpAnswer http_get(std::uint16_t port, std::string_view target) {
  return http(port, "GET " + std::string(target) + " HTTP/1.1\r\nHost: " + own_host(port) +
                        "\r\nConnection: close\r\n\r\n");
}

struct SocketClient::Impl {
  asio::io_context context;
  beast::websocket::stream<tcp::socket> ws;
  int status = 0;
  std::string subprotocol;
  explicit Impl(std::uint16_t port) : ws(connected(context, port)) {}
};

SocketClient::SocketClient(std::uint16_t port, const Opening& opening)
    : impl_(std::make_unique<Impl>(port)) {
  impl_->ws.set_option(
      beast::websocket::stream_base::decorator([opening](beast::websocket::request_type& request) {
        if (!opening.subprotocol.empty())
          request.set(http_ns::field::sec_websocket_protocol, opening.subprotocol);
        if (!opening.origin.empty()) request.set(http_ns::field::origin, opening.origin);
      }));
  beast::websocket::response_type response;
  Error error;
  impl_->ws.handshake(response, opening.host.empty() ? own_host(port) : opening.host, "/ws", error);
  impl_->status = static_cast<int>(response.result_int());
  impl_->subprotocol = std::string(response[http_ns::field::sec_websocket_protocol]);
  impl_->ws.read_message_max(16 * 1024 * 1024);
}

SocketClient::~SocketClient() = default;

int SocketClient::status() const { return impl_->status; }
std::string SocketClient::subprotocol() const { return impl_->subprotocol; }

void SocketClient::text(std::string_view message) {
  Error error;
  impl_->ws.text(true);
  impl_->ws.write(asio::buffer(message), error);
}

void SocketClient::binary(std::string_view message) {
  Error error;
  impl_->ws.binary(true);
  impl_->ws.write(asio::buffer(message), error);
}

void SocketClient::raw(std::string_view bytes) {
  Error error;
  asio::write(impl_->ws.next_layer(), asio::buffer(bytes), error);
}

SocketClient::Received SocketClient::receive(std::chrono::milliseconds patience) {
  beast::flat_buffer buffer;
  std::optional<Error> done;
  impl_->ws.async_read(buffer, [&](Error error, std::size_t) { done = error; });
  impl_->context.restart();
  impl_->context.run_for(patience);
  if (!done) {
    Error ignored;
    impl_->ws.next_layer().close(ignored);
    impl_->context.run();
    return {Kind::nothing, {}};
  }
  if (*done) return {Kind::closed, {}};
  return {impl_->ws.got_text() ? Kind::text : Kind::binary,
          beast::buffers_to_string(buffer.data())};
}

std::string SocketClient::receive_text() {
  for (;;) {
    Received received = receive();
    if (received.kind == Kind::text) return std::move(received.bytes);
    if (received.kind != Kind::binary) return {};
  }
}

}  // namespace earthwork::net
