/// The maps of a server, over HTTP: making one, and asking about one.
#pragma once

#include <cstdint>
#include <string>

#include "client/link/server_address.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::link {

struct MapInfo {
  protocol::MapSettings settings;
  std::uint64_t seq = 0;     ///< Of the map's last event; 0 for a new map.
  std::uint64_t chunks = 0;  ///< That hold anything.
};

/// POST /api/maps. Fails with map_exists where there is one of that name, and with what the server
/// says otherwise.
[[nodiscard]] protocol::Result<void> create_map(const ServerAddress& server,
                                                const std::string& name,
                                                const protocol::MapSettings& settings);

/// GET /api/maps/NAME. Fails with unknown_map where there is none.
[[nodiscard]] protocol::Result<MapInfo> map_info(const ServerAddress& server,
                                                 const std::string& name);

}  // namespace earthwork::link
