/// The HTTP interface: from a request to its answer, without sockets.
#pragma once

#include "server/net/access.hpp"
#include "server/net/http_message.hpp"
#include "server/net/target.hpp"
#include "server/net/workers.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

/// Of a request's body.
inline constexpr std::size_t kMaxBodyBytes = 64 * 1024;

/// Any thread.
class Api {
 public:
  /// Atlas and workers must outlive it, and every request.
  Api(room::Atlas& atlas, Workers& workers, Access access);

  /// Answers through `respond`, exactly once, now or later. Requests that this server's name
  /// was not used for, or that come from another site, are answered 403.
  void handle(HttpRequest request, Respond respond) const;

  /// What has to be right before a request may become a WebSocket.
  [[nodiscard]] protocol::Result<void> check_access(const HttpRequest& request) const;

 private:
  void handle_maps(const HttpRequest& request, Respond respond) const;
  void handle_map(const HttpRequest& request, const Target& target, Respond respond) const;
  void create_map(const HttpRequest& request, Respond respond) const;
  void list_maps(const Respond& respond) const;

  room::Atlas& atlas_;
  Workers& workers_;
  Access access_;
};

}  // namespace earthwork::net
