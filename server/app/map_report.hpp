/// The subcommands that say what is in a data directory and change nothing: `map list`, `info`,
/// `hash` and `verify`. Each gives back the exit code.
#pragma once

#include "server/app/map_flags.hpp"

namespace earthwork::app {

/// A line a map: {"name", "seq", "bytes", "state"}; what is wrong with one is in "detail". Maps are
/// opened and their last event is read, nothing is executed: `verify` tells more.
[[nodiscard]] int list_maps(const MapFlags& flags);
/// {"name", "settings", "epoch", "created_ms", "seq", "hash", "events", "file_bytes",
/// "bytes_per_event", "keyframes"} and every figure that HTTP tells.
[[nodiscard]] int show_map(const MapFlags& flags);
/// {"seq", "hash"}, of the last event or of `seq`: executed, not looked up.
[[nodiscard]] int hash_map(const MapFlags& flags);
/// {"name", "events", "hash", "keyframes", "sound", "findings"}; kFailed unless all is sound, and
/// then what can still be had, on stderr.
[[nodiscard]] int verify_map(const MapFlags& flags);

}  // namespace earthwork::app
