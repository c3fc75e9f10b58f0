#include "client/viewer/view_asker.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/limits.hpp"

namespace earthwork::viewer {

using protocol::ChunkRange;
using protocol::MapPoint;
using protocol::MapRect;
using protocol::MapSettings;

namespace {

// On each side, of the seen part's width and height.
constexpr double kMargin = 0.3;
// Of a part that is too large to be asked for, this much of what was asked must be held, so that
// there is room to move here too.
constexpr double kNeeded = 0.7;
// A view that has so many times the chunks that would be asked for now costs for nothing.
constexpr std::uint64_t kMuchLarger = 6, kNeverTooLarge = 256;

MapRect extent(const MapSettings& settings) {
  const ChunkRange range = protocol::map_extent(settings);
  const double side = settings.chunk_resolution * settings.voxel_size;
  const double shift = settings.voxel_size / 2;  // of cells against voxels
  return {range.x0 * side + shift, range.y0 * side + shift, range.x1 * side + shift,
          range.y1 * side + shift};
}

MapRect clipped(const MapRect& rect, const MapRect& to) {
  return {std::clamp(rect.x0, to.x0, to.x1), std::clamp(rect.y0, to.y0, to.y1),
          std::clamp(rect.x1, to.x0, to.x1), std::clamp(rect.y1, to.y0, to.y1)};
}

MapRect grown(const MapRect& rect) {
  const double x = kMargin * (rect.x1 - rect.x0), y = kMargin * (rect.y1 - rect.y0);
  return {rect.x0 - x, rect.y0 - y, rect.x1 + x, rect.y1 + y};
}

MapRect scaled(const MapRect& rect, MapPoint about, double by) {
  return {about.x + by * (rect.x0 - about.x), about.y + by * (rect.y0 - about.y),
          about.x + by * (rect.x1 - about.x), about.y + by * (rect.y1 - about.y)};
}

MapPoint nearest(MapPoint to, const MapRect& rect) {
  return {std::clamp(to.x, rect.x0, rect.x1), std::clamp(to.y, rect.y0, rect.y1)};
}

/// No more than kMaxViewChunks of it, around `middle`, which lies in it.
MapRect shrunk(MapRect rect, MapPoint middle, const MapSettings& settings) {
  constexpr std::uint64_t kMost = protocol::kMaxViewChunks;
  for (;;) {
    const std::uint64_t count = protocol::chunks_of_cells(rect, settings).count();
    if (count <= kMost) return rect;
    rect = scaled(rect, middle,
                  0.98 * std::sqrt(static_cast<double>(kMost) / static_cast<double>(count)));
  }
}

bool holds(const ChunkRange& outer, const ChunkRange& inner) {
  return inner.empty() || protocol::intersection(outer, inner) == inner;
}

}  // namespace

std::optional<protocol::View> ViewAsker::ask(const MapRect& seen, MapPoint target,
                                             const MapSettings& settings, Time now) {
  due_.reset();
  const MapRect map = extent(settings);
  const MapRect there = clipped(seen, map);
  const MapPoint middle = nearest(target, there);
  const MapRect large = clipped(grown(there), map);
  const MapRect wanted = shrunk(large, middle, settings);
  const MapRect needed = wanted == large ? there : clipped(there, scaled(wanted, middle, kNeeded));
  if (asked_) {
    const std::uint64_t fitting = protocol::chunks_of_cells(wanted, settings).count();
    const bool too_large = asked_->count() > std::max(kMuchLarger * fitting, kNeverTooLarge);
    if (!too_large && holds(*asked_, protocol::chunks_of_cells(needed, settings)))
      return std::nullopt;
    if (now - asked_at_ < kViewEvery) {
      due_ = asked_at_ + kViewEvery;
      return std::nullopt;
    }
  }
  rect_ = wanted;
  asked_ = protocol::chunks_of_cells(wanted, settings);
  asked_at_ = now;
  return protocol::View{.n = ++n_, .rect = wanted, .have = {}, .id = {}};
}

void ViewAsker::forget() {
  asked_.reset();
  due_.reset();
}

}  // namespace earthwork::viewer
