/// The part of a map that a viewer looks at, in chunks.
#pragma once

#include <cstdint>

#include "protocol/chunk_range.hpp"
#include "protocol/messages.hpp"
#include "protocol/settings.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::room {

/// All layers of a rectangle of chunks.
class ViewArea {
 public:
  /// Nothing at all.
  ViewArea() = default;
  /// The chunks whose meshes meet `rect`; the whole map without one.
  ViewArea(const std::optional<protocol::MapRect>& rect, const protocol::MapSettings& settings);

  [[nodiscard]] bool contains(const voxel::ChunkKey& key) const {
    return range_.contains(key.x, key.y);
  }
  /// How far the chunk is from the view's middle: squared, in half chunks. Without a rectangle
  /// the middle is the bounds', or the map's origin.
  [[nodiscard]] std::uint64_t distance(const voxel::ChunkKey& key) const;
  /// What is inside both.
  [[nodiscard]] ViewArea cut_to(const ViewArea& other) const {
    ViewArea both;
    both.range_ = protocol::intersection(range_, other.range_);
    return both;
  }
  [[nodiscard]] const protocol::ChunkRange& range() const { return range_; }

 private:
  protocol::ChunkRange range_;
};

/// `second`, said after `first` and before anything of that was sent: with what `first` claimed, as
/// far as it lies inside it, unless it makes a claim of its own.
[[nodiscard]] protocol::View then_looks(const protocol::View& first, protocol::View second);

}  // namespace earthwork::room
