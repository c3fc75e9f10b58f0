/// A running server: it listens, and gives every connection its place on a pool of threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "protocol/result.hpp"
#include "server/net/listen_address.hpp"
#include "server/net/page_files.hpp"
#include "server/net/session_limits.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

struct ServerOptions {
  ListenAddress listen;
  std::vector<std::string> allowed_hosts;  ///< "HOST" or "HOST:PORT", beside the usual ones.
  int threads = 0;                         ///< For sockets and maps; 0: one a core.
  SessionLimits limits;
  std::shared_ptr<journal::Shelf> shelf{};  ///< Where the maps are; null: in memory.
  std::chrono::milliseconds idle{60'000};   ///< After which a map that nobody uses is put away.
  std::shared_ptr<const PageFiles> page{};  ///< Served at '/'; null: no viewer.
};

/// Any thread.
class Server {
 public:
  /// Listens and serves from now on. Fails with bad_field when it cannot listen there, and as the
  /// shelf does when it cannot tell which maps it has.
  [[nodiscard]] static protocol::Result<std::unique_ptr<Server>> start(
      const ServerOptions& options);
  /// As `stop`.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// The address listened on, with the port that the system picked.
  [[nodiscard]] const ListenAddress& address() const;
  /// "http://HOST:PORT".
  [[nodiscard]] std::string url() const { return "http://" + address().text(); }
  [[nodiscard]] room::Atlas& atlas();

  /// Says bye to the sessions, lets answers finish, stores what was accepted, and ends: within 4 s.
  /// Once is enough, more do no harm. False when a map could not be stored and closed in time.
  bool stop();

 private:
  struct Running;
  explicit Server(std::unique_ptr<Running> running);
  std::unique_ptr<Running> running_;
};

}  // namespace earthwork::net
