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
  [[nodiscard]] const protocol::ChunkRange& range() const { return range_; }

 private:
  protocol::ChunkRange range_;
};

}  // namespace earthwork::room
