/// The map that a new server shows: discs, sharp corners, bites taken out.
#pragma once

#include <vector>

#include "protocol/edit.hpp"
#include "protocol/settings.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::app {

[[nodiscard]] protocol::MapSettings demo_settings();
/// In the order in which they are painted; all of them within every limit.
[[nodiscard]] std::vector<protocol::Edit> demo_edits();

/// Makes the map `demo` and paints it, unless there is one: done before anybody who joins later
/// gets his answer. Waits until it is made, so not on a strand. Fails as Atlas::create does.
[[nodiscard]] protocol::Result<void> add_demo(room::Atlas& atlas);

}  // namespace earthwork::app
