/// A map made of a recording: `map import`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <istream>
#include <memory>

#include "server/app/map_flags.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::app {

/// Events an append, at most: enough that the disk is not what an import waits for, and few enough
/// that little of a log is lost with a batch that is damaged later.
inline constexpr std::size_t kImportBatch = 256;

struct Imported {
  std::uint64_t seq = 0, hash = 0;
  std::unique_ptr<journal::Journal> journal;
};

/// A journal for the recording to go into, empty.
using MakeJournal = std::function<protocol::Result<std::unique_ptr<journal::Journal>>(
    const protocol::MapSettings& settings)>;

/// Executes a recording while it is read, compares every hash, and appends the events with their
/// times, authors and ids; puts a keyframe at the end. Fails where the recording is none, is not
/// whole, or goes beyond a limit, the detail beginning with "line N: "; and as the journal does.
/// A journal that was made then holds a part of it. Holds one map and kImportBatch events.
[[nodiscard]] protocol::Result<Imported> import_recording(std::istream& recording,
                                                          const MakeJournal& make_journal,
                                                          std::int64_t now_ms);

/// Makes the map when all of the recording agrees; else nothing is left of it. Prints {"name",
/// "epoch", "seq", "hash"}. Gives back the exit code.
[[nodiscard]] int import_map(const MapFlags& flags);

}  // namespace earthwork::app
