/// Removes what no keyframe needs from a map file, a little at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/journal/database.hpp"

namespace earthwork::journal {

/// Goes through the chunk rows by their seqs and removes, of each one's chunk, the rows before it
/// that no keyframe comes between; then what lies after the newest keyframe. Rows are looked at
/// once as long as it lives.
class MapTidying {
 public:
  /// Removes up to `most` rows, 1 or more, and true when none is left.
  [[nodiscard]] protocol::Result<bool> run(Database& database, std::size_t most);

 private:
  struct Position {
    std::uint64_t seq = 0;
    std::int64_t layer = -1, place = 0;
    friend auto operator<=>(const Position&, const Position&) = default;
  };
  struct Round {
    std::vector<std::uint64_t> kept;  // keyframes, by seq
    std::size_t rows_left = 0;        // to be removed
    std::size_t looks_left = 0;
    Position at;
    bool done = false;
  };
  [[nodiscard]] static protocol::Result<void> remove_superseded(Database& database, Round& round);
  [[nodiscard]] static protocol::Result<void> remove_unfinished(Database& database, Round& round);

  Position at_;  // rows up to it supersede nothing any more
};

}  // namespace earthwork::journal
