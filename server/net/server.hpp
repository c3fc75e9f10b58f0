/// A running server: it listens, and gives every connection its place on a pool of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "protocol/result.hpp"
#include "server/net/listen_address.hpp"
#include "server/net/session_limits.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

struct ServerOptions {
  ListenAddress listen;
  std::vector<std::string> allowed_hosts;  ///< "HOST" or "HOST:PORT", beside the usual ones.
  int threads = 0;                         ///< For sockets and maps; 0: one a core.
  SessionLimits limits;
};

/// Any thread.
class Server {
 public:
  /// Listens and serves from now on. Fails with bad_field when it cannot listen there.
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

  /// Says bye to the sessions, lets answers finish, and ends: within 4 s. Once is enough, more do
  /// no harm.
  void stop();

 private:
  struct Running;
  explicit Server(std::unique_ptr<Running> running);
  std::unique_ptr<Running> running_;
};

}  // namespace earthwork::net
