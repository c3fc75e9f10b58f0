/// What is drawn over a map's meshes: where it ends, the brush in hand, the cursors of the others.
#pragma once

#include <cstdint>

#include "client/scene/brush.hpp"
#include "client/viewer/people.hpp"
#include "client/viewer/picture.hpp"
#include "protocol/settings.hpp"

namespace earthwork::viewer {

/// Where layer `layer` is painted on and pointed at: its top; 0 for one that is not there.
[[nodiscard]] double height_of(std::uint32_t layer, const protocol::MapSettings& settings);

/// Around a map with bounds; nothing around one without.
void add_border(Picture& picture);
/// The exact edge of the next stamp, aimed at `at`.
void add_own_brush(Picture& picture, const scene::BrushSettings& brush, protocol::MapPoint at);
/// Where the others point: the outline of what they hold, or a small cross.
void add_cursors(Picture& picture, const People& people);

}  // namespace earthwork::viewer
