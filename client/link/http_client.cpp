#include "client/link/http_client.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <exception>
#include <tl/expected.hpp>
#include <utility>

namespace earthwork::link {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

namespace {

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

Request make_request(const ServerAddress& server, http::verb verb, std::string_view target) {
  Request request(verb, beast::string_view(target.data(), target.size()), 11);
  request.set(http::field::host, server.host_header());
  request.set(http::field::user_agent, "earthwork");
  request.keep_alive(false);
  return request;
}

/// The answer, or the error of the first step that failed.
asio::awaitable<tl::expected<Response, error_code>> exchange(ServerAddress server,
                                                             HttpBounds bounds, Request request) {
  const auto executor = co_await asio::this_coro::executor;
  asio::ip::tcp::resolver resolver(executor);
  const auto [unresolved, found] =
      co_await resolver.async_resolve(server.host, std::to_string(server.port), kAwait);
  if (unresolved) co_return tl::unexpected(unresolved);

  beast::tcp_stream stream(executor);
  stream.expires_after(bounds.timeout);
  const auto [unconnected, endpoint] = co_await stream.async_connect(found, kAwait);
  if (unconnected) co_return tl::unexpected(unconnected);
  const auto [unsent, written] = co_await http::async_write(stream, request, kAwait);
  if (unsent) co_return tl::unexpected(unsent);

  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(bounds.max_body_bytes);
  while (!parser.is_done()) {
    stream.expires_after(bounds.timeout);
    const auto [unread, bytes] = co_await http::async_read_some(stream, buffer, parser, kAwait);
    if (unread) co_return tl::unexpected(unread);
  }
  error_code ignored;
  stream.socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  co_return parser.release();
}

protocol::Result<HttpAnswer> ask(const ServerAddress& server, const HttpBounds& bounds,
                                 Request request) {
  tl::expected<Response, error_code> answer;
  std::exception_ptr thrown;
  asio::io_context context(1);
  asio::co_spawn(context, exchange(server, bounds, std::move(request)),
                 [&](std::exception_ptr exception, tl::expected<Response, error_code> outcome) {
                   thrown = exception;
                   answer = std::move(outcome);
                 });
  context.run();
  if (thrown) std::rethrow_exception(thrown);

  if (!answer && answer.error() == http::error::body_limit)
    return protocol::fail(protocol::Code::too_large, server.text() + " answers with more than " +
                                                         std::to_string(bounds.max_body_bytes) +
                                                         " bytes");
  if (!answer)
    return protocol::fail(protocol::Code::internal,
                          server.text() + " cannot be reached: " + answer.error().message());
  return HttpAnswer{.status = static_cast<int>(answer->result_int()),
                    .type = std::string((*answer)[http::field::content_type]),
                    .etag = std::string((*answer)[http::field::etag]),
                    .body = std::move(answer->body())};
}

}  // namespace

protocol::Result<HttpAnswer> http_get(const ServerAddress& server, std::string_view target,
                                      const HttpBounds& bounds) {
  return ask(server, bounds, make_request(server, http::verb::get, target));
}

protocol::Result<HttpAnswer> http_post(const ServerAddress& server, std::string_view target,
                                       std::string body, const HttpBounds& bounds) {
  Request request = make_request(server, http::verb::post, target);
  request.set(http::field::content_type, "application/json");
  request.body() = std::move(body);
  request.prepare_payload();
  return ask(server, bounds, std::move(request));
}

}  // namespace earthwork::link
