/// A map as a file for other programs: `map export`.
#pragma once

#include <cstdint>
#include <optional>
#include <ostream>
#include <string>

#include "server/app/map_flags.hpp"
#include "server/app/new_file.hpp"
#include "server/journal/journal.hpp"
#include "server/journal/restore.hpp"

namespace earthwork::app {

/// The bytes of the server's export.glb of the same map. Fails as net::make_glb does.
[[nodiscard]] protocol::Result<std::string> glb_of(const journal::Restored& restored);
/// The bytes of the server's states.png. Fails as room::draw_states and net::encode_png do.
[[nodiscard]] protocol::Result<std::string> png_of(const journal::Restored& restored,
                                                   std::uint64_t layer);
/// Writes a recording of the events up to `seq`. Gives back the hash after the last of them, 0
/// where there is none. Fails as journal::read_events and NewFile do.
[[nodiscard]] protocol::Result<std::uint64_t> write_recording(journal::Journal& journal,
                                                              std::uint64_t seq, NewFile& out);

/// Writes what the file's ending says - .glb, .png, .jsonl - as of `seq` or the last event, in
/// place of what was there. Prints {"name", "file", "bytes", "seq", "hash"}. Gives back the exit
/// code.
[[nodiscard]] int export_map(const MapFlags& flags);

}  // namespace earthwork::app
