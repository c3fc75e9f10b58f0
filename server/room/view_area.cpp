#include "server/room/view_area.hpp"

#include <algorithm>

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

protocol::View then_looks(const protocol::View& first, protocol::View second) {
  if (second.have || !first.have) return second;
  second.have = first.have;
  if (!first.rect) return second;
  protocol::MapRect& held = second.have->rect;
  held = {.x0 = std::max(held.x0, first.rect->x0),
          .y0 = std::max(held.y0, first.rect->y0),
          .x1 = std::min(held.x1, first.rect->x1),
          .y1 = std::min(held.y1, first.rect->y1)};
  if (held.x0 > held.x1 || held.y0 > held.y1) second.have.reset();
  return second;
}

}  // namespace earthwork::room
