/// Sockets that read whatever comes as fast as it comes, and count it.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages.hpp"
#include "tests/bench/fanout_stream.hpp"

namespace earthwork::bench {

/// A connection to a port of 127.0.0.1. Throws std::runtime_error when the peer is not there, or
/// leaves.
class CrowdSocket {
 public:
  explicit CrowdSocket(std::uint16_t port);
  CrowdSocket(const CrowdSocket&) = delete;
  CrowdSocket& operator=(const CrowdSocket&) = delete;
  ~CrowdSocket();

  /// Asks for a WebSocket at /ws and waits for it; before anything else.
  void upgrade(std::uint16_t port);
  /// Sends a text message.
  void say(std::string_view text);
  /// Reads until so many text messages have come in all.
  void wait_for_texts(std::uint64_t count);
  /// Reads all that is there; answers pings.
  void drain();
  [[nodiscard]] const StreamCounter& stream() const { return stream_; }
  [[nodiscard]] int handle() const { return handle_; }

 private:
  void send_all(std::string_view bytes) const;
  bool read_some(int flags);

  int handle_ = -1;
  StreamCounter stream_;
  std::uint64_t answered_pings_ = 0;
};

class Crowd {
 public:
  Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;
  ~Crowd();

  CrowdSocket& add(std::unique_ptr<CrowdSocket> socket);
  /// Reads for so long.
  void drain_for(std::chrono::nanoseconds duration);
  /// Reads until nothing came for so long.
  void drain_until_quiet(std::chrono::nanoseconds quiet);
  /// Of all together.
  [[nodiscard]] StreamCounts counts() const;

 private:
  bool drain_once(std::chrono::nanoseconds patience);

  int epoll_ = -1;
  std::vector<std::unique_ptr<CrowdSocket>> sockets_;
};

/// A viewer of all of the map "bench", which has all of it.
[[nodiscard]] std::unique_ptr<CrowdSocket> join_as_viewer(std::uint16_t port);

/// Sends edits to the map "bench"; answers are drained with the crowd.
class CrowdEditor {
 public:
  CrowdEditor(Crowd& crowd, std::uint16_t port);
  void paint(const protocol::Edit& edit);

 private:
  CrowdSocket& socket_;
  protocol::MessageId last_id_ = 1;  // of the join
};

}  // namespace earthwork::bench
