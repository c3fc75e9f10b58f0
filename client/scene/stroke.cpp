#include "client/scene/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/chunk_range.hpp"
#include "protocol/limits.hpp"

namespace earthwork::scene {

using protocol::ChunkRange;
using protocol::Edit;
using protocol::MapPoint;
using protocol::MapRect;
using protocol::MapSettings;

namespace {

constexpr double kMaxStampsAtOnce = 100'000;
/// No screen shows more; from here on a way's shares of its length are no longer exact enough.
constexpr double kFurthestVoxels = 1e12;

static_assert((2 * kMaxBrushVoxels + 1) * (2 * kMaxBrushVoxels + 1) * protocol::kMaxPathPoints <=
                  protocol::kMaxEditVisits,
              "a full path of the largest brush is within the limit of voxel visits");

MapPoint along(MapPoint from, MapPoint to, double share) {
  if (share == 1) return to;
  return {from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
}

/// Of a straight way, in shares of its length; empty if `to` is less than `from`.
struct Part {
  double from = 0, to = 1;
  [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// Takes away what is not within low .. high along one axis.
void cut(Part& part, double start, double length, double low, double high) {
  if (length == 0) {
    if (start < low || start > high) part = {.from = 1, .to = 0};
    return;
  }
  const double a = (low - start) / length, b = (high - start) / length;
  part.from = std::max(part.from, std::min(a, b));
  part.to = std::min(part.to, std::max(a, b));
}

Part part_within(const MapRect& rect, MapPoint from, MapPoint to) {
  Part part;
  cut(part, from.x, to.x - from.x, rect.x0, rect.x1);
  cut(part, from.y, to.y - from.y, rect.y0, rect.y1);
  return part;
}

/// Where the centres of stamps are that a map takes and that can change it, and a voxel around,
/// from which they snap there.
MapRect useful_centres(const MapSettings& settings, double radius) {
  const ChunkRange map = protocol::map_extent(settings);
  const double size = settings.voxel_size, chunk = settings.chunk_resolution * size;
  const double reach = radius + 2 * size, world = (protocol::kMaxCoordinateVoxels + 1) * size;
  return {std::max(map.x0 * chunk - reach, -world), std::max(map.y0 * chunk - reach, -world),
          std::min(map.x1 * chunk + reach, world), std::min(map.y1 * chunk + reach, world)};
}

/// Calls `visit(x, y)` for each unit square that the way from `a` to `b` runs through, in order,
/// each a neighbour of the one before across a side; only every `stride`-th and the last.
template <class Visit>
void walk_squares(MapPoint a, MapPoint b, double max_visits, const Visit& visit) {
  const MapPoint last{std::floor(b.x), std::floor(b.y)};
  MapPoint square{std::floor(a.x), std::floor(a.y)};
  const double step_x = last.x < square.x ? -1 : 1, step_y = last.y < square.y ? -1 : 1;
  // The side of the square that the way leaves it by, as a share of the way.
  const auto leaves = [](double start, double end, double at, double step) {
    return (at + (step > 0 ? 1 : 0) - start) / (end - start);
  };
  const double squares = std::abs(last.x - square.x) + std::abs(last.y - square.y) + 1;
  const auto stride = static_cast<std::uint64_t>(std::ceil(squares / max_visits));
  for (std::uint64_t i = 0;; ++i) {
    const bool arrived = square == last;
    if (arrived || i % stride == 0) visit(square.x, square.y);
    if (arrived) return;
    const bool sideways =
        square.y == last.y || (square.x != last.x && leaves(a.x, b.x, square.x, step_x) <=
                                                         leaves(a.y, b.y, square.y, step_y));
    (sideways ? square.x : square.y) += sideways ? step_x : step_y;
  }
}

}  // namespace

Stroke::Stroke(const BrushSettings& brush, const MapSettings& settings, std::int64_t number,
               MapPoint at, Time now)
    : brush_(brush), settings_(settings), number_(number), began_(now), last_(at) {
  brush_.snap = snap_of(brush);
  radius_ = std::clamp(brush.radius_voxels, 0.0, kMaxBrushVoxels) * settings_.voxel_size;
  useful_ = useful_centres(settings_, radius_);
  stamp(at, now);
}

void Stroke::draw_to(MapPoint to, Time now) {
  const double furthest = kFurthestVoxels * settings_.voxel_size;
  const auto near_enough = [&](MapPoint at) {
    return std::abs(at.x) <= furthest && std::abs(at.y) <= furthest;
  };
  if (!near_enough(to)) return;
  const MapPoint from = std::exchange(last_, to);
  if (!near_enough(from)) return;
  if (brush_.snap == Snap::none)
    draw_evenly(from, to, now);
  else
    draw_places(from, to, now);
}

void Stroke::finish(Time now) {
  if (since_last_ > 0) stamp(last_, now);
  since_last_ = 0;
}

std::vector<Edit> Stroke::take() { return std::exchange(ready_, {}); }

void Stroke::draw_evenly(MapPoint from, MapPoint to, Time now) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  if (!(length > 0)) return;
  const auto [begin, end] = part_within(useful_, from, to);
  const double least = std::max(radius_ / 4, settings_.voxel_size / 2);
  const double spacing = std::max(least, (end - begin) * length / kMaxStampsAtOnce);
  // Stamps are made at `first` and every `spacing` after it; those of the useful part are.
  const double first = std::max(spacing - since_last_, 0.0);
  if (length < first) {
    since_last_ += length;
    return;
  }
  since_last_ = std::fmod(length - first, spacing);
  for (double k = std::max(std::ceil((begin * length - first) / spacing), 0.0);; ++k) {
    const double distance = first + k * spacing;
    if (!(distance <= end * length)) return;
    stamp(along(from, to, distance / length), now);
  }
}

void Stroke::draw_places(MapPoint from, MapPoint to, Time now) {
  const Part part = part_within(useful_, from, to);
  if (part.empty()) return;
  const double size = settings_.voxel_size;
  const double shift = brush_.snap == Snap::lines ? 0.5 : 0;  // lines lie between the squares
  const auto voxels = [&](double share) {
    const MapPoint at = along(from, to, share);
    return MapPoint{at.x / size + shift, at.y / size + shift};
  };
  walk_squares(voxels(part.from), voxels(part.to), kMaxStampsAtOnce, [&](double x, double y) {
    const MapPoint inside{(x + 0.5 - shift) * size, (y + 0.5 - shift) * size};
    stamp(inside, now);
  });
}

void Stroke::stamp(MapPoint at, Time now) {
  at = snapped(at, brush_.snap, settings_.voxel_size);
  if (brush_.snap != Snap::none && stamped_ == at) return;
  stamped_ = at;
  const double voxels =
      std::max(std::abs(at.x / settings_.voxel_size), std::abs(at.y / settings_.voxel_size));
  if (!(voxels <= protocol::kMaxCoordinateVoxels)) return;
  if (brush_.layer >= settings_.layers.size()) return;
  const double reach = radius_ + settings_.voxel_size;
  const ChunkRange touched = protocol::chunks_of_voxels(
      {at.x - reach, at.y - reach, at.x + reach, at.y + reach}, settings_);
  if (touched.empty()) return;
  if (stamps_ == kMaxStrokeStamps || now - began_ >= kMaxStrokeTime) {
    ++number_;
    stamps_ = 0;
    began_ = now;
  }
  ++stamps_;
  add_to_edit(at, touched);
}

// Counts chunks as check_edit does for a long way: those that each stamp touches and the one before
// it did not. What it counts for a scribble is less.
void Stroke::add_to_edit(MapPoint at, const ChunkRange& touched) {
  const std::uint64_t entered = touched.count() - intersection(touched, touched_last_).count();
  const bool full = ready_.empty() || ready_.back().stroke != number_ ||
                    ready_.back().path.size() == protocol::kMaxPathPoints ||
                    chunks_ + entered > protocol::kMaxEditChunks;
  if (full) {
    ready_.push_back({.layer = brush_.layer,
                      .stencil = brush_.stencil,
                      .fill = brush_.fill,
                      .radius = radius_,
                      .path = {},
                      .is_path = true,
                      .stroke = number_});
    chunks_ = 0;
  }
  chunks_ += full ? touched.count() : entered;
  touched_last_ = touched;
  ready_.back().path.push_back(at);
}

}  // namespace earthwork::scene
