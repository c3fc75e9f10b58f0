// A wire that breaks: a port on this machine behind which a server is, and which cuts connections
// where a test says.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "client/link/server_address.hpp"

namespace earthwork::e2e {

/// For one client, which has one connection at a time. Requests over HTTP always come through.
class Relay {
 public:
  /// After how many bytes, both ways together, a WebSocket is cut, counted from 0; none: never.
  using Plan = std::function<std::optional<std::size_t>(int connection)>;

  Relay(const link::ServerAddress& server, Plan plan);
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;
  /// Cuts what is left.
  ~Relay();

  [[nodiscard]] std::string url() const { return address_.text(); }
  /// Where connections lead from now on.
  void lead_to(const link::ServerAddress& server);
  [[nodiscard]] int cuts() const { return cuts_; }

 private:
  class Wire;
  void run();
  void serve(int client);

  const Plan plan_;
  link::ServerAddress address_;
  std::mutex mutex_;
  link::ServerAddress server_;  // under the mutex
  int listener_ = -1;
  int connections_ = 0;
  std::atomic<int> cuts_ = 0;
  std::atomic<bool> ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace earthwork::e2e
