#include "server/net/http_connection.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/dynamic_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

#include "server/net/handshake.hpp"
#include "server/net/signal.hpp"
#include "server/net/target.hpp"
#include "server/net/websocket_session.hpp"

namespace earthwork::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::awaitable;
using protocol::Code;
// A body that takes memory as it comes, and none for what its length claims.
using Body = http::basic_dynamic_body<beast::flat_buffer>;
using Parser = http::request_parser<Body>;
// An answer's bytes are sent from where they are: a file of the page is there once, for all.
using BytesElsewhere = http::span_body<const char>;
using Request = http::request<Body>;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
constexpr std::uint32_t kMaxHeaderBytes = 16 * 1024;

std::optional<std::string> header(const Request& request, http::field field) {
  // Of a header given twice one value could be checked and another one meant: together they match
  // nothing.
  const auto [first, last] = request.equal_range(field);
  if (first == last) return std::nullopt;
  std::string values(first->value());
  for (auto at = std::next(first); at != last; ++at) values += ", " + std::string(at->value());
  return values;
}

HttpRequest plain(const Request& request) {
  return {.method = std::string(request.method_string()),
          .target = std::string(request.target()),
          .host = header(request, http::field::host),
          .origin = header(request, http::field::origin),
          .content_type = header(request, http::field::content_type),
          .accept_encoding = header(request, http::field::accept_encoding),
          .if_none_match = header(request, http::field::if_none_match),
          .body = beast::buffers_to_string(request.body().data())};
}

/// The answer to what is no request that can be read; nothing when the peer is just gone.
std::optional<HttpResponse> answer_to(const beast::error_code& error) {
  if (error == http::error::header_limit)
    return problem(431, {Code::too_large, "a header may have 16 KiB", {}});
  if (error == http::error::body_limit)
    return problem(
        413, {Code::too_large, "a body may have " + std::to_string(kMaxBodyBytes) + " bytes", {}});
  if (error == http::error::end_of_stream || error == http::error::partial_message)
    return std::nullopt;
  if (error.category() != make_error_code(http::error::end_of_stream).category())
    return std::nullopt;
  return problem(400, {Code::bad_message, "no HTTP request: " + error.message(), {}});
}

Handshake handshake_of(const Request& request) {
  const std::string protocols = header(request, http::field::sec_websocket_protocol).value_or("");
  return {.version = header(request, http::field::sec_websocket_version),
          .key = header(request, http::field::sec_websocket_key),
          .offers_subprotocol = http::token_list(protocols).exists(kSubprotocol)};
}

HttpResponse too_many(std::size_t connections) {
  HttpResponse response =
      problem(503, {Code::too_large,
                    "connections: the server has " + std::to_string(connections) + ", its most",
                    "connections"});
  response.headers.emplace_back("Retry-After", "5");
  return response;
}

bool opens_websocket(const Request& request) {
  if (!beast::websocket::is_upgrade(request)) return false;
  const auto target = parse_target(std::string_view(request.target()));
  return target && target->segments == std::vector<std::string>{"ws"};
}

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(asio::ip::tcp::socket socket, const Service& service)
      : stream_(std::move(socket)), service_(service), answered_(stream_.get_executor()) {}

  awaitable<void> run(Connections::Id id);
  /// Says that there are too many, and ends.
  awaitable<void> turn_away();

  /// Any thread.
  void stop() {
    asio::post(stream_.get_executor(), [self = shared_from_this()] {
      self->stopping_ = true;
      if (self->idle_) self->stream_.cancel();
    });
  }

 private:
  /// False: the connection ends.
  awaitable<bool> serve_one(Connections::Id id);
  awaitable<beast::error_code> read();
  awaitable<HttpResponse> ask(HttpRequest request);
  awaitable<bool> upgrade(Request request, Connections::Id id);
  awaitable<bool> answer(HttpResponse response, bool keep_alive, bool with_body);
  void close();

  beast::tcp_stream stream_;
  const Service service_;
  beast::flat_buffer buffer_{kMaxHeaderBytes + kMaxBodyBytes};
  std::optional<Parser> parser_;  // of the request being read
  Signal answered_;
  std::optional<HttpResponse> response_;
  bool idle_ = false, stopping_ = false;
};

awaitable<void> HttpConnection::run(Connections::Id id) {
  while (!stopping_ && co_await serve_one(id)) {
  }
  close();
}

awaitable<void> HttpConnection::turn_away() {
  co_await answer(too_many(service_.limits.connections), false, true);
  beast::error_code error;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
  // Closed with a request unread, the connection would be reset and the answer be lost. What comes
  // is dropped, until the peer has read and closed.
  std::array<char, 512> dropped{};
  stream_.expires_after(service_.limits.farewell);
  idle_ = true;
  while (!error && !stopping_)
    std::tie(error, std::ignore) = co_await stream_.async_read_some(asio::buffer(dropped), kAwait);
  close();
}

void HttpConnection::close() {
  beast::error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  stream_.socket().close(ignored);
}

awaitable<bool> HttpConnection::serve_one(Connections::Id id) {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  idle_ = true;
  const beast::error_code error = co_await read();
  idle_ = false;
  if (error) {
    auto response = answer_to(error);
    if (response) co_await answer(std::move(*response), false, true);
    co_return false;
  }

  Request request = parser_->release();
  if (opens_websocket(request)) co_return co_await upgrade(std::move(request), id);
  const bool keep_alive = request.keep_alive();
  const bool with_body = request.method() != http::verb::head;
  HttpResponse response = co_await ask(plain(request));
  co_return co_await answer(std::move(response), keep_alive, with_body);
}

/// The whole request within the time for one, however slowly it trickles.
awaitable<beast::error_code> HttpConnection::read() {
  stream_.expires_after(service_.limits.request);
  const auto [head_error, head_bytes] =
      co_await http::async_read_header(stream_, buffer_, *parser_, kAwait);
  if (head_error) co_return head_error;
  if (!parser_->is_done() && beast::iequals(parser_->get()[http::field::expect], "100-continue")) {
    http::response<http::empty_body> go_on{http::status::continue_, 11};
    const auto [error, bytes] = co_await http::async_write(stream_, go_on, kAwait);
    if (error) co_return error;
  }
  const auto [error, bytes] = co_await http::async_read(stream_, buffer_, *parser_, kAwait);
  co_return error;
}

awaitable<HttpResponse> HttpConnection::ask(HttpRequest request) {
  response_.reset();
  service_.api.handle(std::move(request), [self = shared_from_this()](HttpResponse response) {
    asio::post(self->stream_.get_executor(), [self, response = std::move(response)]() mutable {
      self->response_ = std::move(response);
      self->answered_.notify();
    });
  });
  stream_.expires_never();
  while (!response_) co_await answered_.wait();
  co_return std::move(*response_);
}

awaitable<bool> HttpConnection::upgrade(Request request, Connections::Id id) {
  auto refusal = service_.api.refuse_access(plain(request));
  if (!refusal) refusal = refuse_handshake(handshake_of(request));
  if (refusal) co_return co_await answer(std::move(*refusal), false, true);
  if (buffer_.size() > 0) co_return false;  // frames before the handshake's end
  std::ostringstream handshake;
  handshake << request;
  stream_.expires_never();
  co_await run_session(stream_.release_socket(), handshake.str(), service_, id);
  co_return false;
}

awaitable<bool> HttpConnection::answer(HttpResponse response, bool keep_alive, bool with_body) {
  keep_alive = keep_alive && !stopping_;
  http::response<BytesElsewhere> message{static_cast<http::status>(response.status), 11};
  message.set(http::field::server, "earthwork");
  message.set(http::field::cache_control, "no-cache");
  if (!response.content_type.empty()) message.set(http::field::content_type, response.content_type);
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  message.body() = {response.bytes().data(), response.bytes().size()};
  message.prepare_payload();
  // The length of a 304 would be that of what the client has. Source: RFC 9110, 8.6.
  if (response.status == 304) message.content_length(boost::none);
  if (!with_body) message.body() = {};

  // Part by part: a slow reader may take its time as long as it takes anything.
  http::response_serializer<BytesElsewhere> serializer{message};
  while (!serializer.is_done()) {
    stream_.expires_after(service_.limits.silence);
    const auto [error, bytes] = co_await http::async_write_some(stream_, serializer, kAwait);
    if (error) co_return false;
  }
  co_return keep_alive;
}

}  // namespace

awaitable<void> serve_connection(asio::ip::tcp::socket socket, Service service, Connections::Id id,
                                 Reception reception) {
  try {
    const auto connection = std::make_shared<HttpConnection>(std::move(socket), service);
    service.connections.on_stop(id, [connection] { connection->stop(); });
    if (reception == Reception::served)
      co_await connection->run(id);
    else
      co_await connection->turn_away();
  } catch (const std::exception& error) {
    spdlog::warn("a connection ended: {}", error.what());
  }
  service.connections.remove(id);
}

}  // namespace earthwork::net
