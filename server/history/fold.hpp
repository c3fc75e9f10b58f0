/// From commands to a map: the one place where a protocol action becomes voxels.
#pragma once

#include <vector>

#include "protocol/action.hpp"
#include "protocol/edit.hpp"
#include "protocol/settings.hpp"
#include "server/voxel/map.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::history {

/// An empty map with these settings.
[[nodiscard]] voxel::Map make_map(const protocol::MapSettings& settings);

/// What an edit stamps on its layer, in order.
[[nodiscard]] std::vector<voxel::Stencil> stencils(const protocol::Edit& edit);

/// Applies an edit that `protocol::check_edit` accepted, now or when it was recorded. The result is
/// valid until the map's next edit.
const voxel::Change& apply(voxel::Map& map, const protocol::Edit& edit);
/// The same of whatever was accepted. A change of layers changes no voxel: it may give the map one
/// layer more.
const voxel::Change& apply(voxel::Map& map, const protocol::Action& action);

}  // namespace earthwork::history
