/// A client's connection to a map: says hello, joins, sends messages, hands on what comes back.
///
/// A connection is made once; when it is lost, the link is closed and says why.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/link/closing.hpp"
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
  std::optional<int> receive_buffer_bytes = std::nullopt;  ///< As of SocketOptions.
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
  /// The same for a message that was written already.
  [[nodiscard]] protocol::Result<void> send_written(std::string text);
  /// More should be sent only later: replies tell when.
  [[nodiscard]] bool congested() const { return socket_.queued_bytes() > kQueueHighWaterBytes; }
  /// While it is paused nothing is handed on, and the server can send no more than the buffers
  /// take. A link that was paused once does not notice silence by itself any more.
  void pause_reading(bool paused) { socket_.pause_reading(paused); }
  /// Sends what is queued, says goodbye and calls `closed`; nothing that arrives from now on is
  /// handed on.
  void close();

 private:
  enum class Phase { connecting, greeting, joining, ready, closing };

  [[nodiscard]] tl::unexpected<protocol::Failure> not_ready() const;
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
