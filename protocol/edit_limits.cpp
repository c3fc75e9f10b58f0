// check_edit: what an edit costs, counted without touching a map.
#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/chunk_range.hpp"
#include "protocol/edit.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"

namespace earthwork::protocol {
namespace {

tl::unexpected<Failure> refuse(Code code, const char* field, const std::string& sentence) {
  return fail(code, std::string(field) + ": " + sentence, field);
}

Result<void> check_coordinates(const Edit& edit, double voxel_size) {
  const char* field = edit.is_path ? "path" : "x";
  for (std::size_t i = 0; i < edit.path.size(); ++i) {
    const MapPoint& point = edit.path[i];
    const double x = std::abs(point.x / voxel_size), y = std::abs(point.y / voxel_size);
    if (std::max(x, y) <= kMaxCoordinateVoxels) continue;
    const std::string where = edit.is_path ? "element " + std::to_string(i) + " at " : "";
    return refuse(Code::out_of_range, edit.is_path || x > kMaxCoordinateVoxels ? field : "y",
                  where + plain(std::max(x, y)) + " voxels from 0 is beyond the limit of " +
                      plain(kMaxCoordinateVoxels));
  }
  return {};
}

/// Voxels in a stamp's bounding square, at most.
std::uint64_t visits_per_stamp(double radius_voxels) {
  const auto side = static_cast<std::uint64_t>(2 * radius_voxels) + 1;
  return side * side;
}

/// The chunks one stamp can change (GEOMETRY, stencils, 3).
ChunkRange stamp_chunks(const MapPoint& centre, const Edit& edit, const MapSettings& settings) {
  const double reach = edit.radius + settings.voxel_size;
  return chunks_of_voxels({centre.x - reach, centre.y - reach, centre.x + reach, centre.y + reach},
                          settings);
}

/// No fewer than the edit touches: the lesser of the chunks of the path's bounding rectangle, and
/// of those that each stamp touches and the stamp before it did not, added up. The first is exact
/// enough for a scribble, the second for a long stroke.
std::uint64_t count_chunks(const Edit& edit, const MapSettings& settings) {
  MapPoint low = edit.path.front(), high = low;
  std::uint64_t entered = 0;
  ChunkRange before;
  for (const MapPoint& centre : edit.path) {
    low = {std::min(low.x, centre.x), std::min(low.y, centre.y)};
    high = {std::max(high.x, centre.x), std::max(high.y, centre.y)};
    const ChunkRange now = stamp_chunks(centre, edit, settings);
    entered += now.count() - intersection(now, before).count();
    before = now;
  }
  const double reach = edit.radius + settings.voxel_size;
  const MapRect bounds{low.x - reach, low.y - reach, high.x + reach, high.y + reach};
  return std::min(entered, chunks_of_voxels(bounds, settings).count());
}

}  // namespace

Result<void> check_edit(const Edit& edit, const MapSettings& settings) {
  if (auto checked = check_layer(edit, settings); !checked) return checked;
  return check_stamps(edit, settings);
}

Result<void> check_layer(const Edit& edit, const MapSettings& settings) {
  if (edit.layer < settings.layers.size()) return {};
  return refuse(Code::out_of_range, "layer",
                std::to_string(edit.layer) + " is outside 0 .. " +
                    std::to_string(settings.layers.size() - 1));
}

Result<void> check_stamps(const Edit& edit, const MapSettings& settings) {
  const double radius_voxels = edit.radius / settings.voxel_size;
  if (!(radius_voxels <= kMaxRadiusVoxels))
    return refuse(
        Code::out_of_range, "radius",
        plain(radius_voxels) + " voxels is beyond the limit of " + plain(kMaxRadiusVoxels));
  if (auto checked = check_coordinates(edit, settings.voxel_size); !checked) return checked;
  const char* costly = edit.is_path ? "path" : "radius";
  const std::uint64_t visits = visits_per_stamp(radius_voxels) * edit.path.size();
  if (visits > kMaxEditVisits)
    return refuse(Code::too_large, costly,
                  std::to_string(visits) + " voxel visits are beyond the limit of " +
                      std::to_string(kMaxEditVisits));
  const std::uint64_t chunks = count_chunks(edit, settings);
  if (chunks > kMaxEditChunks)
    return refuse(Code::too_large, costly,
                  std::to_string(chunks) + " chunks are beyond the limit of " +
                      std::to_string(kMaxEditChunks));
  return {};
}

}  // namespace earthwork::protocol
