/// Clients that are written against the bytes, and may behave as badly as they like.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace earthwork::net {

/// A TCP connection to 127.0.0.1.
class TcpClient {
 public:
  explicit TcpClient(std::uint16_t port);
  ~TcpClient();

  /// The port of this end, by which the other end's socket can be told from others.
  [[nodiscard]] std::uint16_t own_port() const;
  /// False when the server has closed.
  bool send(std::string_view bytes);
  /// What comes up to `end`, and `end`; what came behind it is read next. Without one, what came
  /// until the server closed, or for a minute.
  std::string read_until(const std::string& end);
  /// The head of an answer, its blank line included.
  std::string read_head() { return read_until("\r\n\r\n"); }
  /// All that comes until the server closes; `closed` says whether it did within the time.
  std::string read_to_end(std::chrono::milliseconds patience, bool& closed);
  std::string read_to_end(bool& closed) { return read_to_end(std::chrono::minutes(1), closed); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What opens a WebSocket, as text; `host` is HOST:PORT.
[[nodiscard]] std::string handshake_text(std::string_view host);
/// A text frame of up to 125 bytes under a mask of zeros.
[[nodiscard]] std::string masked_text(std::string_view message);

struct HttpAnswer {
  int status = 0;                              ///< 0: none came.
  std::map<std::string, std::string> headers;  ///< Names in lower case.
  std::string body;
};
/// Sends `request` as it stands on a new connection and reads one answer.
[[nodiscard]] HttpAnswer http(std::uint16_t port, std::string_view request);
/// "GET target" with the right Host and Connection: close.
[[nodiscard]] HttpAnswer http_get(std::uint16_t port, std::string_view target);

/// A WebSocket.
class SocketClient {
 public:
  struct Opening {
    std::string subprotocol = "earthwork.v1";
    std::string host{};    ///< Empty: the right one.
    std::string origin{};  ///< Empty: none.
  };
  explicit SocketClient(std::uint16_t port) : SocketClient(port, Opening{}) {}
  SocketClient(std::uint16_t port, const Opening& opening);
  ~SocketClient();

  /// 101 when it is open, else what the server answered.
  [[nodiscard]] int status() const;
  /// The subprotocol that the server chose.
  [[nodiscard]] std::string subprotocol() const;

  void text(std::string_view message);
  void binary(std::string_view message);
  /// Bytes beneath the WebSocket.
  void raw(std::string_view bytes);

  enum class Kind { text, binary, closed, nothing };
  struct Received {
    Kind kind = Kind::nothing;
    std::string bytes;
  };
  /// The next message; `nothing` when none comes in time, and then the client is done for.
  Received receive(std::chrono::milliseconds patience = std::chrono::minutes(1));
  /// The next text, binary ones skipped; empty when there is none.
  std::string receive_text();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace earthwork::net
