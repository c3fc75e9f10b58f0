#include "server/voxel/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace earthwork::voxel {
namespace {

/// Halves away from zero. Written out because the library's rounding is a call, and adding a half
/// before truncating is wrong for the number just below a half.
std::int32_t round_away(double v) {
  const auto whole = static_cast<std::int32_t>(v);
  const double rest = v - whole;
  return whole + (rest >= 0.5 ? 1 : 0) - (rest <= -0.5 ? 1 : 0);
}

std::uint16_t quantise(double cut, double lower, double voxel_size) {
  const double steps = (cut - lower) / voxel_size * kEdgeSteps + 0.5;
  if (steps < 1) return 1;
  if (steps >= kEdgeSteps - 1) return kEdgeSteps - 1;
  return static_cast<std::uint16_t>(steps);
}

}  // namespace

bool Coverage::covers(double along, double across) const {
  const double r = stencil_.radius;
  if (stencil_.shape == Shape::square) return std::abs(along) <= r && std::abs(across) <= r;
  return along * along + across * across <= r * r;
}

// The estimate is off by less than a voxel; it is taken one too wide and then trimmed by the
// exact test, which is what decides.
Run Coverage::row_run(std::int32_t j) const {
  const double across = position(j) - stencil_.y, r = stencil_.radius;
  double half = r;
  if (stencil_.shape == Shape::circle) half = std::sqrt(std::max(0.0, r * r - across * across));
  const auto index = [this](double at) { return at / voxel_size_ - 0.5; };
  Run run{static_cast<std::int32_t>(std::floor(index(stencil_.x - half))) - 1,
          static_cast<std::int32_t>(std::ceil(index(stencil_.x + half))) + 1};
  const auto covered = [&](std::int32_t i) { return covers(position(i) - stencil_.x, across); };
  while (run.first <= run.last && !covered(run.first)) ++run.first;
  while (run.first <= run.last && !covered(run.last)) --run.last;
  return run;
}

void Coverage::assign(const Stencil& stencil, double voxel_size) {
  stencil_ = stencil;
  voxel_size_ = voxel_size;
  runs_.clear();
  left_ = 0, right_ = -1;
  const double y = stencil.y, r = stencil.radius;
  const auto first = static_cast<std::int32_t>(std::floor((y - r) / voxel_size - 0.5)) - 1;
  const auto last = static_cast<std::int32_t>(std::ceil((y + r) / voxel_size - 0.5)) + 1;
  const bool square = stencil.shape == Shape::square;
  Run run;
  for (std::int32_t j = first; j <= last; ++j) {
    if (!covers(0, position(j) - y)) continue;
    if (!square || runs_.empty()) run = row_run(j);
    if (runs_.empty()) {
      if (run.first > run.last) continue;
      bottom_ = j, left_ = run.first, right_ = run.last;
    }
    runs_.push_back(run);
    if (run.first > run.last) continue;
    left_ = std::min(left_, run.first), right_ = std::max(right_, run.last);
  }
  while (!runs_.empty() && runs_.back().first > runs_.back().last) runs_.pop_back();
}

Crossing Coverage::cut(Axis axis, std::int32_t i, std::int32_t j, End covered) const {
  double along = stencil_.x, across = stencil_.y;
  std::int32_t lower = i, line = j;
  if (axis == Axis::y) std::swap(along, across), std::swap(lower, line);
  const double r = stencil_.radius;
  double h = r;
  std::int32_t out = kNormalUnit, side = 0;  // the outward normal along the edge and across it
  // Where r * r is below the normal numbers its root is not r any more. Such a circle covers only a
  // voxel right at its centre, where d = 0 and h = r: the normal is the axis, as for r = 0.
  if (stencil_.shape == Shape::circle && r * r >= std::numeric_limits<double>::min()) {
    const double d = position(line) - across;
    h = std::sqrt(r * r - d * d);
    out = round_away((kNormalUnit * h) / r);
    side = round_away((kNormalUnit * d) / r);
  }
  if (covered == End::upper) out = -out;
  if (stencil_.fill == Fill::empty) out = -out, side = -side;
  Normal normal{static_cast<std::int16_t>(out), static_cast<std::int16_t>(side)};
  if (axis == Axis::y) std::swap(normal.x, normal.y);
  return {quantise(covered == End::lower ? along + h : along - h, position(lower), voxel_size_),
          normal};
}

}  // namespace earthwork::voxel
