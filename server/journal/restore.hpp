/// A map as of a seq, made from its journal.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/journal/chunk_ages.hpp"
#include "server/journal/journal.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::journal {

struct Restored {
  voxel::Map map;
  protocol::MapSettings settings;  ///< As of `seq`.
  std::uint64_t seq = 0, hash = 0;
  std::vector<ChunkAge> ages;  ///< Of every chunk that ever held something; in order.
  /// What is to be remembered as of `seq`, in order of the authors. When `seq` is not the last one,
  /// ids up to the keyframe may be missing: those that later ones have pushed out.
  std::vector<AuthorState> authors;
  std::uint64_t keyframe_seq = 0;  ///< Where it started; 0: from an empty map.
  /// Why it did not start from a later keyframe: for people to be told. Empty when it is strict.
  std::vector<protocol::Failure> passed_over;
};

enum class Trust {
  strict,   ///< The newest keyframe up to the seq must be sound: what a server goes on from.
  salvage,  ///< One that is damaged, or that the log does not go on from, is passed over for an
            ///< earlier one, and at last for the log from its start.
};

/// As of `seq`, or of the last event. Checks all that it reads: sums, that no number is missing,
/// and the map's hash after the keyframe and after every event. Fails with out_of_range when the
/// journal does not reach `seq`, and with what the journal fails with, or `damaged`. Holds the map,
/// and kPageBytes of the log.
[[nodiscard]] protocol::Result<Restored> restore(Journal& journal, std::optional<std::uint64_t> seq,
                                                 Trust trust);

}  // namespace earthwork::journal
