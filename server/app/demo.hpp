/// The map that a new server shows: discs, sharp corners, bites taken out.
#pragma once

#include <functional>
#include <vector>

#include "protocol/edit.hpp"
#include "protocol/settings.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::app {

[[nodiscard]] protocol::MapSettings demo_settings();
/// In the order in which they are painted; all of them within every limit.
[[nodiscard]] std::vector<protocol::Edit> demo_edits();

/// Makes the map `demo` and paints it, unless there is one; then, when it is stored, calls `done`,
/// from any thread. Fails as Atlas::create does, and with storage_failed when not all was stored.
void add_demo(room::Atlas& atlas, std::function<void(protocol::Result<void>)> done);

}  // namespace earthwork::app
