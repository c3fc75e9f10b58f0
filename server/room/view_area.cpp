#include "server/room/view_area.hpp"

namespace earthwork::room {

ViewArea::ViewArea(const std::optional<protocol::MapRect>& rect,
                   const protocol::MapSettings& settings)
    : range_(rect ? protocol::chunks_of_cells(*rect, settings) : protocol::map_extent(settings)) {}

std::uint64_t ViewArea::distance(const voxel::ChunkKey& key) const {
  // Twice the centre's coordinates are integers.
  const auto offset = [](std::int64_t at, std::int64_t from, std::int64_t to) {
    return 2 * at + 1 - (from + to);
  };
  const std::int64_t dx = offset(key.x, range_.x0, range_.x1);
  const std::int64_t dy = offset(key.y, range_.y0, range_.y1);
  return static_cast<std::uint64_t>(dx * dx + dy * dy);
}

}  // namespace earthwork::room
