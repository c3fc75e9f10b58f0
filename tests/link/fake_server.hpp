// A server that a test plays: on a port of its own and a thread of its own, one connection after
// the other, each handed to a function that reads and writes as the test likes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "client/link/server_address.hpp"

namespace earthwork::link {

/// One accepted WebSocket, blocking. After an error, or the client's close, `read` gives back
/// "closed CODE" and writing does nothing.
class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string read() = 0;
  /// Bytes that have come and of which nothing was read.
  virtual std::size_t waiting_bytes() = 0;
  virtual void write(const std::string& text) = 0;
  virtual void write_binary(const std::string& bytes) = 0;
  virtual void close(std::uint16_t code) = 0;
};

class FakeServer {
 public:
  /// Accepts WebSockets and answers with this subprotocol, or with none when it is empty.
  FakeServer(std::string subprotocol, std::function<void(Peer&)> play);
  /// Answers every HTTP request with these bytes, or never when they are none; `request` receives
  /// what was asked.
  explicit FakeServer(std::string answer, std::string* request = nullptr);
  FakeServer(const FakeServer&) = delete;
  FakeServer& operator=(const FakeServer&) = delete;
  /// Waits for the connection that is being played.
  ~FakeServer();

  ServerAddress address() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// An address on this machine where nobody listens.
ServerAddress nobody();

}  // namespace earthwork::link
