/// A session that behaves, on a thread of its own: what others must not notice, it would.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>

#include "tests/net/raw_client.hpp"

namespace earthwork::net {

/// The next text that answers or ends something, as JSON: news of other people, events and word
/// that a view is complete are skipped. Null when there is none.
[[nodiscard]] nlohmann::json reply(SocketClient& client);
/// Says hello, and joins `map`; the ids 1 and 2 are taken then. Throws when it may not.
void enter(SocketClient& client, const std::string& map);

/// Watches a corner of the map and paints in it all the time, one edit after the other.
class Painter {
 public:
  Painter(std::uint16_t port, std::string map);
  ~Painter();

  /// True once an edit that was sent after the call has been applied; false when anything else came
  /// in answer to any edit since the painter began, or nothing for a minute.
  [[nodiscard]] bool is_answered();

 private:
  void paint();

  SocketClient client_;
  const std::string map_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t applied_ = 0;
  bool failed_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace earthwork::net
