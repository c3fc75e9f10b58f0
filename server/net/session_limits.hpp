/// How long a connection may take, and how much it may ask for.
#pragma once

#include <chrono>
#include <cstddef>

namespace earthwork::net {

struct SessionLimits {
  std::chrono::milliseconds hello{10'000};    ///< From the WebSocket's opening to a valid hello.
  std::chrono::milliseconds silence{30'000};  ///< Without a byte either way; half of it: a ping.
  std::chrono::milliseconds request{10'000};  ///< For an HTTP request to arrive, or for the next.
  std::chrono::milliseconds farewell{2'000};  ///< From bye to the end of the connection.
  std::size_t connections = 4096;             ///< At a time; more are answered 503 and closed.
  double messages_per_second = 10'000;        ///< Of a session; beyond it, it is not read.
  double message_burst = 2'000;
};

}  // namespace earthwork::net
