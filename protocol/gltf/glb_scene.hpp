/// The JSON part of a GLB file.
#pragma once

#include <string>

#include "protocol/gltf/glb_layout.hpp"

namespace earthwork::protocol {

/// Nodes, meshes, materials and the layout of the one buffer, `layout.bytes` long.
[[nodiscard]] Result<std::string> glb_scene(const MapSettings& settings, const GlbLayout& layout);

}  // namespace earthwork::protocol
