#include "server/net/websocket_session.hpp"

#include <algorithm>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "protocol/limits.hpp"
#include "server/net/conversation.hpp"
#include "server/net/rate.hpp"
#include "server/net/signal.hpp"
#include "server/room/asio_strand.hpp"

namespace earthwork::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::awaitable;
using protocol::Code;
using Clock = std::chrono::steady_clock;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);

// Small, so that control never waits behind megabytes that the kernel has already taken.
constexpr int kSendBufferBytes = 64 * 1024, kSendLowWaterBytes = 16 * 1024;

/// A whole number among TCP's socket options, as Asio takes options.
struct TcpOption {
  int key = 0, value = 0;
  template <class Protocol>
  [[nodiscard]] int level(const Protocol&) const {
    return IPPROTO_TCP;
  }
  template <class Protocol>
  [[nodiscard]] int name(const Protocol&) const {
    return key;
  }
  template <class Protocol>
  [[nodiscard]] const int* data(const Protocol&) const {
    return &value;
  }
  template <class Protocol>
  [[nodiscard]] std::size_t size(const Protocol&) const {
    return sizeof value;
  }
};

/// A rate policy that limits nothing, but is told of every transfer, parts of messages included.
class ActivityPolicy {
 public:
  [[nodiscard]] Clock::time_point last_byte() const { return last_byte_; }
  /// Whether written bytes count; received ones always do.
  void count_written(bool count) { count_written_ = count; }

 private:
  friend class beast::rate_policy_access;

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

using Stream = beast::basic_stream<asio::ip::tcp, asio::any_io_executor, ActivityPolicy>;

/// Beast ends a session through errors it makes itself; here all ends come from the coroutines.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(asio::ip::tcp::socket socket, const Service& service)
      : ws_(std::move(socket)),
        limits_(service.limits),
        readable_(ws_.get_executor()),
        writable_(ws_.get_executor()),
        never_(ws_.get_executor()),
        rate_(limits_.messages_per_second, limits_.message_burst, Clock::now()),
        conversation_(std::make_shared<Conversation>(
            service.atlas, room::wrap_serial_executor(ws_.get_executor()), [this] { wake(); })) {}

  awaitable<void> run(std::string handshake);

  /// Any thread.
  void stop() {
    asio::post(ws_.get_executor(), [self = shared_from_this()] {
      self->conversation_->say_bye({Code::shutting_down, "the server ends", {}});
    });
  }

 private:
  awaitable<void> converse(std::string handshake);
  void end();
  void set_options();
  void wake() { readable_.notify(), writable_.notify(); }
  awaitable<void> read();
  awaitable<bool> read_message();
  awaitable<void> write();
  awaitable<void> watch();
  void check_time(Clock::time_point now);
  void ping();
  void close_socket();
  awaitable<void> sleep(std::chrono::nanoseconds time);

  websocket::stream<Stream> ws_;
  const SessionLimits limits_;
  Signal readable_, writable_, never_;
  Rate rate_;
  beast::flat_buffer buffer_;
  const std::shared_ptr<Conversation> conversation_;
  Clock::time_point opened_ = Clock::now();
  Clock::time_point bye_at_ = Clock::time_point::max();
  bool writing_ = false, pinging_ = false;
};

void WebSocketSession::set_options() {
  auto& socket = beast::get_lowest_layer(ws_).socket();
  beast::error_code ignored;
  socket.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
  socket.set_option(TcpOption{TCP_NOTSENT_LOWAT, kSendLowWaterBytes}, ignored);
  // A peer that is gone without a word acknowledges nothing: the kernel then ends the connection.
  socket.set_option(TcpOption{TCP_USER_TIMEOUT, static_cast<int>(limits_.silence.count())},
                    ignored);

  ws_.set_option(websocket::stream_base::timeout{.handshake_timeout = limits_.farewell,
                                                 .idle_timeout = websocket::stream_base::none(),
                                                 .keep_alive_pings = false});
  ws_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    response.set(beast::http::field::sec_websocket_protocol, kSubprotocol);
  }));
  ws_.read_message_max(0);  // read_message has its own limit, with a better answer
  ws_.auto_fragment(false);
}

awaitable<void> WebSocketSession::run(std::string handshake) {
  try {
    co_await converse(std::move(handshake));
  } catch (...) {
    end();
    throw;
  }
  end();
}

/// The conversation may outlive the session in its room, and must not wake it then.
void WebSocketSession::end() {
  close_socket();
  conversation_->abandon();
}

awaitable<void> WebSocketSession::converse(std::string handshake) {
  using namespace asio::experimental::awaitable_operators;
  set_options();
  const auto [error] = co_await ws_.async_accept(asio::buffer(handshake), kAwait);
  if (!error) {
    opened_ = Clock::now();
    co_await (read() || write() || watch());
  }
}

awaitable<void> WebSocketSession::read() {
  for (;;) {
    while (!conversation_->ending() && !conversation_->may_read()) co_await readable_.wait();
    if (!conversation_->ending()) co_await sleep(rate_.take(Clock::now()));
    // After bye, the writer ends the session: it must not be cut short.
    while (conversation_->ending()) co_await never_.wait();

    if (!co_await read_message()) break;
    if (conversation_->ending()) continue;
    if (ws_.got_binary()) {
      conversation_->refuse_binary();
    } else {
      const auto bytes = buffer_.cdata();
      conversation_->receive({static_cast<const char*>(bytes.data()), bytes.size()});
    }
    buffer_.consume(buffer_.size());
  }
  close_socket();
}

/// One message into the buffer, or bye when it is too long; false when the peer is gone.
awaitable<bool> WebSocketSession::read_message() {
  do {
    const std::size_t room = protocol::kMaxControlBytes + 1 - buffer_.size();
    const auto [error, bytes] = co_await ws_.async_read_some(buffer_, room, kAwait);
    if (error) co_return false;
    if (buffer_.size() > protocol::kMaxControlBytes) {
      conversation_->say_bye(
          {Code::too_large,
           "a message may have " + std::to_string(protocol::kMaxControlBytes) + " bytes",
           {}});
      co_return true;
    }
  } while (!ws_.is_message_done());
  co_return true;
}

awaitable<void> WebSocketSession::write() {
  for (;;) {
    while (const auto message = conversation_->next_message()) {
      ws_.text(message->kind == Kind::text);
      writing_ = true;
      const auto [error, bytes] = co_await ws_.async_write(asio::buffer(message->bytes), kAwait);
      writing_ = false;
      if (error) co_return close_socket();
      conversation_->sent(*message);
      // What was not read while too much waited may be read now.
      readable_.notify();
    }
    if (conversation_->ended()) break;
    co_await writable_.wait();
  }
  co_await ws_.async_close(websocket::close_code::normal, kAwait);
  close_socket();
}

awaitable<void> WebSocketSession::watch() {
  using std::chrono::milliseconds;
  const auto step = std::clamp(std::min(limits_.hello, limits_.silence) / 8, milliseconds(10),
                               milliseconds(1000));
  for (;;) {
    co_await sleep(step);
    const auto now = Clock::now();
    check_time(now);
    if (conversation_->ending() && bye_at_ == Clock::time_point::max()) bye_at_ = now;
    if (conversation_->ending() && now - bye_at_ > limits_.farewell) break;
  }
  close_socket();
}

void WebSocketSession::check_time(Clock::time_point now) {
  if (!conversation_->greeted() && now - opened_ > limits_.hello)
    return conversation_->say_bye({Code::timeout, "no hello came", {}});
  const auto silence = now - beast::get_lowest_layer(ws_).rate_policy().last_byte();
  if (silence > limits_.silence)
    return conversation_->say_bye({Code::timeout, "nothing was heard for too long", {}});
  if (silence > limits_.silence / 2) ping();
}

void WebSocketSession::ping() {
  // While a message is being written, its bytes say whether the peer is there.
  if (pinging_ || writing_ || conversation_->ending()) return;
  auto& policy = beast::get_lowest_layer(ws_).rate_policy();
  pinging_ = true;
  policy.count_written(false);  // only the answer to a ping says anything
  ws_.async_ping({}, [self = shared_from_this(), &policy](const beast::error_code&) {
    policy.count_written(true);
    self->pinging_ = false;
  });
}

void WebSocketSession::close_socket() {
  beast::error_code ignored;
  beast::get_lowest_layer(ws_).socket().close(ignored);
}

awaitable<void> WebSocketSession::sleep(std::chrono::nanoseconds time) {
  if (time.count() <= 0) co_return;
  asio::steady_timer timer(ws_.get_executor(), time);
  co_await timer.async_wait(kAwait);
}

}  // namespace

awaitable<void> run_session(asio::ip::tcp::socket socket, std::string handshake, Service service,
                            Connections::Id connection) {
  const auto session = std::make_shared<WebSocketSession>(std::move(socket), service);
  service.connections.on_stop(connection, [session] { session->stop(); });
  co_await session->run(std::move(handshake));
}

}  // namespace earthwork::net
