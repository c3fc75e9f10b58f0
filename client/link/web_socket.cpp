#include "client/link/web_socket.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/field.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <optional>
#include <tuple>
#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::link {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

namespace {

constexpr const char* kSubprotocol = "earthwork.v1";
constexpr const char* kTarget = "/ws";
// Errors come back as values: a peer that leaves is no exception.
constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);

struct Outgoing {
  std::string bytes;
  bool text = true;
};

enum class Idle { ends, bears };

websocket::stream_base::timeout timeouts(Idle idle) {
  websocket::stream_base::timeout out{};
  out.handshake_timeout = kOpenTimeout;
  out.idle_timeout = idle == Idle::ends ? kIdleTimeout : websocket::stream_base::none();
  out.keep_alive_pings = idle == Idle::ends;
  return out;
}

}  // namespace

// Kept alive by its own coroutine. A reader and a writer share the socket; whichever ends first
// closes it, which ends the other.
class WebSocket::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(asio::io_context& context, ServerAddress server, SocketHandlers handlers,
             SocketOptions options)
      : server_(std::move(server)),
        options_(options),
        handlers_(std::move(handlers)),
        resolver_(context),
        socket_(std::in_place, context),
        wake_(context, asio::steady_timer::time_point::max()),
        resume_(context, asio::steady_timer::time_point::max()) {}

  void start() { asio::co_spawn(wake_.get_executor(), live(shared_from_this()), asio::detached); }

  void write(Outgoing message) {
    if (closing_ || ended_) return;
    queued_bytes_ += message.bytes.size();
    queue_.push_back(std::move(message));
    wake_.cancel();
  }

  std::size_t queued_bytes() const { return queued_bytes_; }

  void close() {
    closing_ = true;
    handlers_.text = nullptr;
    handlers_.binary = nullptr;
    wake_.cancel();
    resume_.cancel();
    if (!open_) cut();
  }

  void pause_reading(bool paused) {
    paused_ = paused;
    // Silence is then its own doing, or of a peer that is waiting for it.
    if (socket_ && open_) socket_->set_option(timeouts(Idle::bears));
    resume_.cancel();
  }

  void abandon() {
    handlers_ = {};
    cut();
  }

 private:
  // The parameter keeps the object alive as long as the coroutine is.
  static asio::awaitable<void> live(std::shared_ptr<Connection> self) {
    co_await self->open();
    if (self->open_) {
      self->call(self->handlers_.opened);
      using asio::experimental::awaitable_operators::operator&&;
      co_await (self->read_all() && self->write_all());
    }
    self->finish();
  }

  asio::awaitable<void> open() {
    auto& tcp = beast::get_lowest_layer(*socket_);
    const std::string port = std::to_string(server_.port);
    // A name that does not resolve is given up by the resolver itself.
    const auto [unresolved, found] = co_await resolver_.async_resolve(server_.host, port, kAwait);
    if (unresolved) co_return end(SocketEnd::unreachable, unresolved.message());
    if (ended_) co_return;

    tcp.expires_after(kOpenTimeout);
    const error_code unconnected = co_await connect_to_one_of(found);
    if (unconnected) co_return end(SocketEnd::unreachable, unconnected.message());
    error_code ignored;
    tcp.socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    tcp.expires_never();
    co_await shake_hands();
  }

  // The first that answers; the error is that of the last. A receive buffer has to be known before
  // the connection is made: the window is agreed then.
  asio::awaitable<error_code> connect_to_one_of(asio::ip::tcp::resolver::results_type found) {
    auto& tcp = beast::get_lowest_layer(*socket_);
    error_code error = asio::error::host_not_found;
    for (const auto& entry : found) {
      error_code ignored;
      tcp.socket().close(ignored);
      tcp.socket().open(entry.endpoint().protocol(), ignored);
      if (options_.receive_buffer_bytes)
        tcp.socket().set_option(
            asio::socket_base::receive_buffer_size(*options_.receive_buffer_bytes), ignored);
      std::tie(error) = co_await tcp.async_connect(entry.endpoint(), kAwait);
      if (!error || ended_ || error == beast::error::timeout) break;
    }
    co_return error;
  }

  asio::awaitable<void> shake_hands() {
    socket_->set_option(timeouts(paused_ ? Idle::bears : Idle::ends));
    socket_->set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, kSubprotocol);
    }));
    socket_->read_message_max(protocol::kMaxServerControlBytes);
    socket_->auto_fragment(false);
    websocket::response_type answer;
    const auto [error] =
        co_await socket_->async_handshake(answer, server_.host_header(), kTarget, kAwait);
    if (error == websocket::error::upgrade_declined)
      co_return end(SocketEnd::unreachable,
                    "it answers " + std::to_string(answer.result_int()) + " to a WebSocket");
    if (error) co_return end(SocketEnd::unreachable, error.message());
    if (answer[beast::http::field::sec_websocket_protocol] != kSubprotocol)
      co_return end(SocketEnd::unreachable, std::string("it does not speak ") + kSubprotocol);
    open_ = !ended_;
  }

  asio::awaitable<void> read_all() {
    beast::flat_buffer buffer;
    while (!ended_) {
      const auto [error, bytes] = co_await socket_->async_read(buffer, kAwait);
      if (error) {
        end_reading(error);
        break;
      }
      while (paused_ && !closing_ && !ended_) co_await resume_.async_wait(kAwait);
      hand_on(buffer.data());
      buffer.consume(buffer.size());
    }
    wake_.cancel();
  }

  void end_reading(const error_code& error) {
    if (closing_ || (error == websocket::error::closed &&
                     socket_->reason().code == websocket::close_code::normal))
      return end(SocketEnd::closed, {});
    if (error == websocket::error::closed)
      return end(SocketEnd::lost,
                 "it closed the connection with code " + std::to_string(socket_->reason().code));
    end(SocketEnd::lost, error.message());
  }

  void hand_on(asio::const_buffer bytes) {
    const auto* first = static_cast<const std::byte*>(bytes.data());
    if (socket_->got_text()) {
      call(handlers_.text, std::string_view(reinterpret_cast<const char*>(first), bytes.size()));
    } else if (bytes.size() > protocol::kMaxFrameBytes) {
      end(SocketEnd::lost,
          "a binary message is longer than " + std::to_string(protocol::kMaxFrameBytes) + " bytes");
    } else {
      call(handlers_.binary, std::span(first, bytes.size()));
    }
  }

  asio::awaitable<void> write_all() {
    while (!ended_) {
      if (queue_.empty()) {
        if (closing_) break;
        co_await wake_.async_wait(kAwait);
        continue;
      }
      const Outgoing message = std::move(queue_.front());
      queue_.pop_front();
      queued_bytes_ -= message.bytes.size();
      socket_->text(message.text);
      const auto [error, bytes] =
          co_await socket_->async_write(asio::buffer(message.bytes), kAwait);
      // The reader knows better why: it may have read the peer's close.
      if (error) break;
    }
    if (closing_ && !ended_) {
      static_cast<void>(co_await socket_->async_close(websocket::close_code::normal, kAwait));
      end(SocketEnd::closed, {});
    }
  }

  // The first call decides what the end was.
  void end(SocketEnd how, std::string why) {
    if (!ended_) {
      how_ = how;
      why_ = std::move(why);
    }
    cut();
  }

  void cut() {
    ended_ = true;
    resolver_.cancel();
    if (socket_) beast::get_lowest_layer(*socket_).close();
    wake_.cancel();
    resume_.cancel();
  }

  void finish() {
    socket_.reset();  // its timers would keep the loop running
    if (closing_) how_ = SocketEnd::closed;
    const auto closed = std::move(handlers_.closed);
    handlers_ = {};
    if (closed) closed(how_, how_ == SocketEnd::closed ? std::string() : why_);
  }

  // A handler may destroy the socket, and with it the handlers: a copy is called.
  template <class... Parameters, class... Arguments>
  void call(const std::function<void(Parameters...)>& handler, Arguments&&... arguments) {
    const auto copy = handler;
    if (copy) copy(std::forward<Arguments>(arguments)...);
  }

  const ServerAddress server_;
  const SocketOptions options_;
  SocketHandlers handlers_;
  asio::ip::tcp::resolver resolver_;
  std::optional<websocket::stream<beast::tcp_stream>> socket_;  // until it has ended
  asio::steady_timer wake_;    // never expires; cancelled when the writer has something to do
  asio::steady_timer resume_;  // likewise, when the reader may go on
  std::deque<Outgoing> queue_;
  std::size_t queued_bytes_ = 0;
  bool open_ = false, closing_ = false, ended_ = false, paused_ = false;
  SocketEnd how_ = SocketEnd::closed;
  std::string why_;
};

WebSocket::WebSocket(EventLoop& loop, const ServerAddress& server, SocketHandlers handlers,
                     SocketOptions options)
    : connection_(
          std::make_shared<Connection>(loop.context(), server, std::move(handlers), options)) {
  connection_->start();
}

WebSocket::~WebSocket() { connection_->abandon(); }

void WebSocket::write_text(std::string message) {
  connection_->write({.bytes = std::move(message), .text = true});
}

void WebSocket::write_binary(std::string message) {
  connection_->write({.bytes = std::move(message), .text = false});
}

std::size_t WebSocket::queued_bytes() const { return connection_->queued_bytes(); }

void WebSocket::pause_reading(bool paused) { connection_->pause_reading(paused); }

void WebSocket::close() { connection_->close(); }

}  // namespace earthwork::link
