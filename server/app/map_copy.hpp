/// Maps that come of others, and maps that go: `map fork` and `map delete`. Each gives back the
/// exit code.
#pragma once

#include "server/app/map_flags.hpp"

namespace earthwork::app {

/// A map of its own, with the log up to `seq` or whole and a new epoch. Prints {"name", "epoch",
/// "seq"}.
[[nodiscard]] int fork_map(const MapFlags& flags);
/// Prints {"name", "deleted": true}.
[[nodiscard]] int delete_map(const MapFlags& flags);

}  // namespace earthwork::app
