/// Watches a map: the meshes of all of it, from received frames alone; when the connection breaks,
/// it goes on over another one with what it has.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "client/link/closing.hpp"
#include "client/link/server_address.hpp"
#include "client/scene/scene.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

struct WatchOptions {
  link::ServerAddress server;
  std::string map;
  std::optional<std::uint64_t> until_seq;              ///< Ends once all meshes show this event.
  std::optional<std::chrono::nanoseconds> time_limit;  ///< From the answer to the first join.
  /// Without a connection for so long, the server is gone for good.
  std::chrono::milliseconds patience{60'000};
};

struct WatchReport {
  scene::Scene scene;
  protocol::MapSettings settings;
  bool complete = false;                ///< All of the map was there, as of until_seq or later.
  bool joined = false;                  ///< The map was joined, once at least.
  std::optional<link::Closing> broken;  ///< Why there was no connection in the end.
};

/// Ends when all of the map is there, as of `until_seq` where it is given; a time limit alone ends
/// nothing early. Also ends on SIGINT and SIGTERM. What goes wrong is told on `log`, a line each.
/// Blocks; a loop of its own.
[[nodiscard]] WatchReport watch(const WatchOptions& options, std::ostream& log);

}  // namespace earthwork::bot
