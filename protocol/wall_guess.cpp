#include "protocol/wall_guess.hpp"

#include <cmath>
#include <cstdlib>

namespace earthwork::protocol {
namespace {

constexpr std::int32_t kStep = 32768, kFirst = kStep / 2;
constexpr double kUnit = 32767, kFar = 8388608;  // 2^23: past all coordinates

/// A point or direction seen from a line: along it, and across.
struct Seen {
  double along, across;
};
template <class Pair>
Seen seen(GridLine line, const Pair& p) {
  const double x = p.x, y = p.y;
  return line == GridLine::row ? Seen{x, y} : Seen{y, x};
}

/// The wall's direction: its normal a quarter to the left.
MeshPoint tangent(MeshNormal normal) { return {-normal.y, normal.x}; }

std::int32_t rounded(double value, double otherwise) {
  const double v = std::fabs(value) < kFar ? value : otherwise;
  return static_cast<std::int32_t>(std::floor(v + 0.5));
}

/// Along `line` at `position`, on the circle of the last two normals; `otherwise` when there is
/// none or it does not get there.
double on_circle(const WallEnd& end, GridLine line, double position, double otherwise) {
  if (!end.bend) return otherwise;
  const double nx = end.normal.x - end.bend->normal.x, ny = end.normal.y - end.bend->normal.y;
  const double dx = end.at.x - end.bend->from.x, dy = end.at.y - end.bend->from.y;
  const double reach = (dx * nx + dy * ny) / (nx * nx + ny * ny);  // radius over the unit normal
  const Seen at = seen(line, end.at), normal = seen(line, end.normal);
  const double along = at.along - reach * normal.along, across = at.across - reach * normal.across;
  const double radius = reach * kUnit, off = position - across;
  const double square = radius * radius - off * off;
  if (!(square >= 0)) return otherwise;
  const double root = std::sqrt(square);
  const double high = along + root, low = along - root;
  return std::fabs(high - at.along) < std::fabs(low - at.along) ? high : low;
}

MeshNormal normal_of(double x, double y) {
  const double scale = kUnit / std::sqrt(x * x + y * y);
  return {static_cast<std::int16_t>(std::floor(x * scale + 0.5)),
          static_cast<std::int16_t>(std::floor(y * scale + 0.5))};
}

}  // namespace

std::int32_t line_beside(const WallEnd& end, GridLine line, bool behind) {
  const MeshPoint going = tangent(end.normal);
  const std::int32_t at = line == GridLine::row ? end.at.y : end.at.x;
  const bool up = ((line == GridLine::row ? going.y : going.x) >= 0) != behind;
  // The first line lies at kFirst; what comes before it counts from one line lower.
  const std::int32_t from_line = at + kStep - kFirst;
  const std::int32_t index = up ? from_line / kStep + 1 : (from_line + kStep - 1) / kStep - 1;
  return kFirst + (index - 1) * kStep;
}

std::int32_t guess_on_line(const WallEnd& end, GridLine line, std::int32_t position) {
  const Seen at = seen(line, end.at), going = seen(line, tangent(end.normal));
  double guess = at.along;
  if (going.across != 0) guess += (position - at.across) * going.along / going.across;
  if (!(std::fabs(guess - at.along) < 2 * kStep)) guess = at.along;
  return rounded(on_circle(end, line, position, guess), at.along);
}

std::int32_t guess_beside(const WallEnd& end, bool by_x, std::int32_t step) {
  const MeshPoint going = tangent(end.normal);
  const double ahead = by_x ? going.x : going.y, beside = by_x ? going.y : going.x;
  return rounded(ahead == 0 ? 0.0 : step * beside / ahead, 0);
}

bool runs_along_x(MeshNormal normal) { return std::abs(normal.y) > std::abs(normal.x); }

MeshNormal straight_normal(MeshPoint a, MeshPoint b) {
  const double x = b.y - a.y, y = a.x - b.x;  // to the right of a -> b
  return normal_of(x, y);
}

// The normals at the ends of a chord mirror each other in the line through its middle and the
// centre.
MeshNormal round_normal(MeshPoint a, MeshPoint b, MeshNormal at_a) {
  const double x = b.y - a.y, y = a.x - b.x;
  const double turn = 2 * (at_a.x * x + at_a.y * y) / (x * x + y * y);
  return normal_of(turn * x - at_a.x, turn * y - at_a.y);
}

}  // namespace earthwork::protocol
