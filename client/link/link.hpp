/// A client's connection to a map: says hello, joins, sends messages, hands on what comes back.
///
/// A connection is made once; when it is lost, the link is closed and says why.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/link/event_loop.hpp"
#include "client/link/server_address.hpp"
#include "client/link/web_socket.hpp"
#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "protocol/result.hpp"

namespace earthwork::link {

/// The hello and the join may each take this long.
inline constexpr std::chrono::seconds kAnswerTimeout{10};
/// While more than this waits to be written, `Link::congested` is true.
inline constexpr std::size_t kQueueHighWaterBytes = 1024 * 1024;
/// What `Link::send` lets wait at most.
inline constexpr std::size_t kMaxQueueBytes = 4 * 1024 * 1024;

struct LinkOptions {
  ServerAddress server;
  protocol::Hello hello;
  std::string map;  ///< Joined after the welcome. Empty: no join, and the link is ready then.
};

enum class CloseCause {
  asked,        ///< By `Link::close`.
  unreachable,  ///< No connection, or what answered does not speak the protocol.
  refused,      ///< The server refused the hello or the join.
  lost,         ///< The connection broke, the server said bye, or sent what is no message.
};

struct Closing {
  CloseCause cause = CloseCause::asked;
  protocol::Failure failure;  ///< For people, naming the server; empty when asked.
};

/// Each may be empty. They are called on the loop's thread, never from within a call to the link,
/// and must not destroy it.
struct LinkHandlers {
  /// The hello and the join were answered; `send` may be called.
  std::function<void()> ready;
  /// Every control message that arrives, the welcome and the answer to the join included.
  std::function<void(const protocol::ServerMessage& message)> message;
  /// What was complete with a binary message of `message_bytes`: perhaps nothing.
  std::function<void(std::vector<protocol::FrameEvent>& events, std::size_t message_bytes)> frame;
  /// The last call, exactly once.
  std::function<void(const Closing& closing)> closed;
};

/// All on the loop's thread. Messages of the server are bounded by kMaxServerControlBytes of text
/// and kMaxFrameBytes of binary; a longer one closes the link.
class Link {
 public:
  /// Starts to connect; everything further happens while the loop runs.
  Link(EventLoop& loop, LinkOptions options, LinkHandlers handlers);
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  /// Cuts the connection without a word; no handler is called any more.
  ~Link() = default;

  /// Queues a message. Fails with bad_state before the link is ready and once it closes, with
  /// too_large when the message is longer than kMaxControlBytes or the queue is full.
  [[nodiscard]] protocol::Result<void> send(const protocol::ClientMessage& message);
  /// More should be sent only later: replies tell when.
  [[nodiscard]] bool congested() const { return socket_.queued_bytes() > kQueueHighWaterBytes; }
  /// Sends what is queued, says goodbye and calls `closed`; nothing that arrives from now on is
  /// handed on.
  void close();

 private:
  enum class Phase { connecting, greeting, joining, ready, closing };

  void greet();
  void take_text(std::string_view text);
  void take_binary(std::span<const std::byte> bytes);
  void advance(const protocol::ServerMessage& message);
  void be_ready();
  void expect_answer(Phase phase, const char* to_what);
  void end(CloseCause cause, protocol::Failure failure);
  void socket_closed(SocketEnd how, const std::string& why);

  LinkOptions options_;
  LinkHandlers handlers_;
  Phase phase_ = Phase::connecting;
  protocol::FrameReader frames_;
  std::vector<protocol::FrameEvent> events_;
  std::optional<Closing> closing_;  // why, once the link itself has decided to end
  Timer deadline_;
  WebSocket socket_;  // last: it calls back into all of the above
};

}  // namespace earthwork::link
