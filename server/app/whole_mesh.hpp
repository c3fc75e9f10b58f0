/// The meshes of a map that nobody watches, made all at once.
#pragma once

#include "protocol/settings.hpp"
#include "server/room/mesh_cache.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::app {

/// Every mesh that a server would send of it, with `seq` as its revision.
[[nodiscard]] room::MeshCache mesh_whole(const voxel::Map& map,
                                         const protocol::MapSettings& settings, std::uint64_t seq);

}  // namespace earthwork::app
