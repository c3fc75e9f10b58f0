/// The map that a bot is to paint.
#pragma once

#include <string>

#include "client/link/maps.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

/// Makes the map, unless there is one of that name with equal settings already. Fails with
/// map_exists when its settings are others.
[[nodiscard]] protocol::Result<link::MapInfo> make_map(const link::ServerAddress& server,
                                                       const std::string& name,
                                                       const protocol::MapSettings& settings);

}  // namespace earthwork::bot
