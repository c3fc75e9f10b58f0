/// A WebSocket client: whole messages in and out, and a close with a reason. What the messages
/// mean is `Link`'s matter.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "client/link/event_loop.hpp"
#include "client/link/server_address.hpp"

namespace earthwork::link {

/// Reaching the server takes no longer, the WebSocket handshake included.
inline constexpr std::chrono::seconds kOpenTimeout{10};
/// Silence that loses the connection; after half of it the socket pings.
inline constexpr std::chrono::seconds kIdleTimeout{30};

enum class SocketEnd {
  closed,       ///< By `close`, or by the peer with code 1000.
  unreachable,  ///< There never was a connection.
  lost,
};

/// Each may be empty. They are called on the loop's thread, never from within a call to the
/// socket, and may destroy it.
struct SocketHandlers {
  std::function<void()> opened;
  /// Valid during the call. At most kMaxServerControlBytes; a longer message loses the connection.
  std::function<void(std::string_view message)> text;
  /// Valid during the call. At most kMaxFrameBytes; a longer message loses the connection.
  std::function<void(std::span<const std::byte> message)> binary;
  /// The last call, exactly once. `why` is a sentence for people; empty when closed.
  std::function<void(SocketEnd end, const std::string& why)> closed;
};

struct SocketOptions {
  /// Of the system's buffer for what arrived and was not read; the system has a least of its own.
  std::optional<int> receive_buffer_bytes = std::nullopt;
};

/// All on the loop's thread.
class WebSocket {
 public:
  /// Starts to connect to /ws with the subprotocol earthwork.v1; everything further happens while
  /// the loop runs.
  WebSocket(EventLoop& loop, const ServerAddress& server, SocketHandlers handlers,
            SocketOptions options = {});
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  /// Cuts the connection without a word; no handler is called any more.
  ~WebSocket();

  /// Queues a text message, without a limit: the caller watches `queued_bytes`.
  void write_text(std::string message);
  /// Queues a binary message.
  void write_binary(std::string message);
  /// Of messages that are not yet on their way.
  [[nodiscard]] std::size_t queued_bytes() const;
  /// While it is paused, no handler is told of a message, and the peer can send no more than the
  /// buffers take. A socket that was paused once does not notice silence by itself any more.
  void pause_reading(bool paused);
  /// Writes what is queued and closes; nothing that arrives from now on is handed on.
  void close();

 private:
  class Connection;
  std::shared_ptr<Connection> connection_;
};

}  // namespace earthwork::link
