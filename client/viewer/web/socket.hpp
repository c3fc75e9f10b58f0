/// The browser's WebSocket to the server that the page came from.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace earthwork::viewer {

/// Told from the browser's event loop, never from within a call to the socket.
class SocketListener {
 public:
  virtual void socket_opened() = 0;
  virtual void socket_told(std::string_view text) = 0;
  virtual void socket_told(std::span<const std::byte> message) = 0;
  /// Also when it could not be opened. 1006 when there was no closing code.
  virtual void socket_closed(int code, std::string_view reason) = 0;

 protected:
  ~SocketListener() = default;
};

/// One connection at a time. The listener hears nothing more of one that `close` ended.
class Socket {
 public:
  explicit Socket(SocketListener& listener) : listener_(listener) {}
  ~Socket() { close(); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// The page came from a server, so there is an address to connect to.
  [[nodiscard]] static bool has_server();
  /// To /ws of the page's own host, encrypted if the page is. One that is open is closed before.
  void open();
  /// Nothing is sent unless it is open. No NUL in the text.
  void send(std::string_view text);
  void close();

 private:
  SocketListener& listener_;
  int handle_ = 0;  // 0: none
};

}  // namespace earthwork::viewer
