// check_view: how much of a map a view may ask for; check_seen: where what people see may lie.
#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {

Result<void> check_view(const View& view, const MapSettings& settings) {
  if (!view.rect) return {};
  const std::uint64_t chunks = chunks_of_cells(*view.rect, settings).count();
  if (chunks <= kMaxViewChunks) return {};
  return fail(Code::too_large,
              "rect: " + std::to_string(chunks) + " chunks are beyond the limit of " +
                  std::to_string(kMaxViewChunks),
              "rect");
}

Result<void> check_seen(const MapRect& view, const MapSettings& settings) {
  const double furthest =
      std::max({std::abs(view.x0), std::abs(view.y0), std::abs(view.x1), std::abs(view.y1)}) /
      settings.voxel_size;
  if (furthest <= kMaxCoordinateVoxels) return {};
  return fail(Code::out_of_range,
              "view: " + plain(furthest) + " voxels from 0 is beyond the limit of " +
                  plain(kMaxCoordinateVoxels),
              "view");
}

}  // namespace earthwork::protocol
