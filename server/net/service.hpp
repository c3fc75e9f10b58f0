/// What every connection of a server works with.
#pragma once

#include "server/net/api.hpp"
#include "server/net/connections.hpp"
#include "server/net/session_limits.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

/// What it refers to outlives the connections. Copied freely.
struct Service {
  room::Atlas& atlas;
  const Api& api;
  Connections& connections;
  SessionLimits limits;
};

}  // namespace earthwork::net
