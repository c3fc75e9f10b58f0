/// A map as of a seq, made from its journal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/journal/journal.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::journal {

/// Since when a chunk of the file is as it is, or is gone: it changed by no event after `seq`.
struct ChunkAge {
  voxel::ChunkKey key;
  std::uint64_t seq = 0;
};

struct Restored {
  voxel::Map map;
  std::uint64_t seq = 0, hash = 0;
  std::vector<ChunkAge> ages;        ///< Of every chunk that ever held something; in order.
  std::vector<AuthorState> authors;  ///< As of `seq` when that is the last; in order.
  std::uint64_t keyframe_seq = 0;    ///< Where it started; 0: from an empty map.
};

enum class Trust {
  strict,   ///< The newest keyframe up to the seq must be sound: what a server goes on from.
  salvage,  ///< A damaged one is passed over for an earlier one, or for the log from its start.
};

/// As of `seq`, or of the last event. Checks all that it reads: sums, that no number is missing,
/// and the map's hash after the keyframe and after every event. Fails with out_of_range when the
/// journal does not reach `seq`, and with what the journal fails with, or `damaged`.
[[nodiscard]] protocol::Result<Restored> restore(Journal& journal, std::optional<std::uint64_t> seq,
                                                 Trust trust);

}  // namespace earthwork::journal
