/// The server to compare with: an epoll loop that sends ready messages, and nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "tests/bench/child_process.hpp"

namespace earthwork::bench {

enum class Sending : char {
  one_by_one = '1',  ///< A send for every message.
  together = '8',    ///< One send for all that are due.
};

inline constexpr std::size_t kPlainMessages = 8;  ///< To everybody, at every `send`.

/// A process of its own. Its messages are WebSocket messages with one chunk record, of the size
/// given; there is no handshake.
class PlainWriter {
 public:
  explicit PlainWriter(std::size_t message_bytes);
  ~PlainWriter();
  PlainWriter(const PlainWriter&) = delete;
  PlainWriter& operator=(const PlainWriter&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const ChildProcess& process() const { return *process_; }
  /// Makes it send kPlainMessages messages to everybody who is connected; what a socket does not
  /// take waits there, and goes first.
  void send(Sending how) const;

 private:
  int orders_ = -1;
  std::uint16_t port_ = 0;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace earthwork::bench
