/// A map's figures by the names that people and conformance know them under.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/room/room.hpp"

namespace earthwork::net {

/// An object of every figure that protocol/README.md lists under HTTP. `resolution`: the map's
/// voxels along a chunk's side.
[[nodiscard]] nlohmann::ordered_json write_figures(const room::RoomFigures& figures,
                                                   int resolution);

}  // namespace earthwork::net
