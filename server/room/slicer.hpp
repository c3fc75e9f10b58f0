/// The one edit of a room that is too large to be applied at once: it is prepared in slices, each a
/// task of its own, so that the edits of others get through meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/edit.hpp"
#include "protocol/settings.hpp"
#include "server/room/line.hpp"
#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"
#include "server/voxel/sliced_edit.hpp"

namespace earthwork::room {

/// Of rows of chunks, a row once a stamp, which is what an edit takes time with: some 20 ns each.
/// What costs more than kMostRowsAtOnce is prepared, about kSliceRows at a time.
inline constexpr std::uint64_t kMostRowsAtOnce = 65'536;
inline constexpr std::uint64_t kSliceRows = 32'768;

/// The rows of the chunks that an edit looks at, a chunk once a stamp, or of a few more.
[[nodiscard]] std::uint64_t rows_visited(const protocol::Edit& edit,
                                         const protocol::MapSettings& settings);

/// While it is busy, the map is changed only by edits that need not wait. On the map's strand.
class Slicer {
 public:
  /// The map outlives it.
  explicit Slicer(voxel::Map& map) : map_(map) {}

  /// Its cost is its rows_visited.
  [[nodiscard]] static bool too_large(const Line::Waiting& edit) {
    return edit.cost > kMostRowsAtOnce;
  }

  [[nodiscard]] bool busy() const { return prepared_.has_value(); }
  /// Nothing is left to do but `commit`.
  [[nodiscard]] bool through() const { return prepared_ && prepared_->through; }
  /// Who made the edit in preparation. When busy.
  [[nodiscard]] std::uint64_t author() const { return prepared_->author; }
  /// Whether this one must not be applied before `commit`: it may touch what is in preparation, or
  /// is too large as well. False when not busy, and for a change of layers: what is in preparation
  /// has its layer already.
  [[nodiscard]] bool must_wait(const Line::Waiting& edit) const;

  /// An edit of a layer that the map has. When not busy. Does no work yet.
  void start(const Command& command);
  /// The next slice; when busy.
  void advance();
  /// The chunks that `commit` puts into the map. When through.
  [[nodiscard]] std::span<const voxel::ChunkKey> changed() const {
    return prepared_->edit.changed();
  }
  /// Puts the edit into the map, and gives what voxel::Map::apply would have given now. When
  /// through; it is not busy afterwards.
  [[nodiscard]] voxel::Change commit();
  /// Forgets the edit in preparation, if there is one.
  void clear() { prepared_.reset(); }

 private:
  struct Prepared {
    std::uint64_t author;
    voxel::SlicedEdit edit;
    bool through = false;
  };

  voxel::Map& map_;
  std::optional<Prepared> prepared_;
};

}  // namespace earthwork::room
