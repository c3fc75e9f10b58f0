#include "server/net/websocket_session.hpp"

#include <algorithm>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "protocol/limits.hpp"
#include "server/net/buffered_socket.hpp"
#include "server/net/conversation.hpp"
#include "server/net/rate.hpp"
#include "server/net/signal.hpp"
#include "server/net/websocket_frame.hpp"
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

// Messages for one call, and the one that crosses it: a group of 16 KiB leaves as a whole. What is
// not taken yet can still be overtaken, and what a viewer that does not read leaves here stays
// below 37 KiB.
constexpr std::size_t kEnoughBytes = 20 * 1024;
constexpr std::size_t kKeptBufferBytes = 4096;

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

// Nothing is compressed, so nothing is kept for it.
using Stream = websocket::stream<BufferedSocket, false>;

/// Counts a session among those that are open. One that a stopping server did not wait for goes
/// with the context it ran on, after the atlas.
class OpenSession {
 public:
  explicit OpenSession(std::shared_ptr<room::Meters> meters) : meters_(std::move(meters)) {
    ++meters_->sessions;
  }
  ~OpenSession() { --meters_->sessions; }
  OpenSession(const OpenSession&) = delete;
  OpenSession& operator=(const OpenSession&) = delete;

 private:
  const std::shared_ptr<room::Meters> meters_;
};

/// Beast ends a session through errors it makes itself; here all ends come from the coroutines.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(asio::ip::tcp::socket socket, const Service& service)
      : ws_(std::move(socket)),
        meters_(service.atlas.shared_meters()),
        limits_(service.limits),
        readable_(ws_.get_executor()),
        said_all_(ws_.get_executor()),
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
  void wake();
  awaitable<void> read();
  awaitable<bool> read_message();
  void receive();
  awaitable<void> say_farewell();
  awaitable<void> watch();
  BufferedSocket& socket() { return ws_.next_layer(); }
  void flush_soon();
  void flush();
  [[nodiscard]] beast::error_code send_more();
  void wait_writable();
  void check_time(Clock::time_point now);
  void ping();
  awaitable<void> sleep(std::chrono::nanoseconds time);

  Stream ws_;
  const std::shared_ptr<room::Meters> meters_;
  const SessionLimits limits_;
  Signal readable_, said_all_, never_;
  Rate rate_;
  beast::flat_buffer buffer_;
  const std::shared_ptr<Conversation> conversation_;
  Clock::time_point opened_ = Clock::now();
  Clock::time_point bye_at_ = Clock::time_point::max();
  bool receiving_ = false, flushing_soon_ = false;
  bool stuck_ = false;  // until the socket takes more
};

void WebSocketSession::set_options() {
  auto& socket = this->socket().socket();
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
  this->socket().on_output([this] { flush_soon(); });
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
  socket().close();
  conversation_->abandon();
}

awaitable<void> WebSocketSession::converse(std::string handshake) {
  using namespace asio::experimental::awaitable_operators;
  set_options();
  const auto [error] = co_await ws_.async_accept(asio::buffer(handshake), kAwait);
  if (error) co_return;
  const OpenSession open(meters_);
  opened_ = Clock::now();
  flush_soon();  // bye may have been said already
  co_await (read() || say_farewell() || watch());
}

awaitable<void> WebSocketSession::read() {
  for (;;) {
    while (!conversation_->ending() && !conversation_->may_read()) co_await readable_.wait();
    if (!conversation_->ending()) co_await sleep(rate_.take(Clock::now()));
    // After bye, the writer ends the session: it must not be cut short.
    while (conversation_->ending()) co_await never_.wait();

    if (!co_await read_message()) break;
    if (conversation_->ending()) continue;
    receiving_ = true;
    receive();
    receiving_ = false;
  }
  socket().close();
}

void WebSocketSession::receive() {
  if (ws_.got_binary()) {
    conversation_->refuse_binary();
  } else {
    const auto bytes = buffer_.cdata();
    conversation_->receive({static_cast<const char*>(bytes.data()), bytes.size()});
  }
  buffer_.consume(buffer_.size());
  // Most messages are short: who has sent a long one does not keep the memory for it.
  if (buffer_.capacity() > kKeptBufferBytes) buffer_.shrink_to_fit();
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

/// After the last message, or when the peer is gone.
awaitable<void> WebSocketSession::say_farewell() {
  while (!conversation_->ended() && socket().socket().is_open()) co_await said_all_.wait();
  co_await ws_.async_close(websocket::close_code::normal, kAwait);
  socket().close();
}

/// What a room brings leaves at once. Answers to what the client has sent in one go leave in one
/// go.
void WebSocketSession::wake() {
  if (receiving_)
    flush_soon();
  else
    flush();
}

void WebSocketSession::flush_soon() {
  if (flushing_soon_ || stuck_) return;
  flushing_soon_ = true;
  asio::post(ws_.get_executor(), [self = shared_from_this()] { self->flush(); });
}

void WebSocketSession::flush() {
  flushing_soon_ = false;
  try {
    if (!stuck_ && socket().socket().is_open() && send_more()) socket().close();
  } catch (...) {
    socket().close();  // messages may be lost
    throw;
  }
  if (!socket().socket().is_open() || conversation_->ended()) said_all_.notify();
  // What was not read while too much waited may be read now.
  readable_.notify();
}

beast::error_code WebSocketSession::send_more() {
  // One for all sessions of a thread: it stays in the caches, and who has nothing to say or is
  // quick to read has no memory for it.
  static thread_local std::string messages;
  messages.clear();
  if (const auto error = socket().flush()) return error;
  if (socket().flushed()) {
    conversation_->written();
    if (ws_.is_open()) conversation_->take_output(messages, kEnoughBytes);
    if (const auto error = socket().send(messages)) return error;
  }
  if (!socket().flushed()) {
    wait_writable();
    return {};
  }
  conversation_->written();
  // What the kernel does not need yet stays with the room, where it costs less and is kept new.
  if (messages.size() >= kEnoughBytes) wait_writable();
  return {};
}

void WebSocketSession::wait_writable() {
  stuck_ = true;
  socket().async_wait_writable([self = shared_from_this()](const beast::error_code& error) {
    self->stuck_ = false;
    if (!error) self->flush();
  });
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
  socket().close();
}

void WebSocketSession::check_time(Clock::time_point now) {
  if (!conversation_->greeted() && now - opened_ > limits_.hello)
    return conversation_->say_bye({Code::timeout, "no hello came", {}});
  const auto silence = now - socket().last_byte();
  if (silence > limits_.silence)
    return conversation_->say_bye({Code::timeout, "nothing was heard for too long", {}});
  if (silence > limits_.silence / 2) ping();
}

void WebSocketSession::ping() {
  // What waits says, by leaving or by staying, whether the peer is there.
  if (stuck_ || !socket().flushed() || !ws_.is_open() || conversation_->ending()) return;
  if (socket().send_ping(kPing)) return socket().close();
  if (!socket().flushed()) wait_writable();
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
