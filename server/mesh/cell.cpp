#include "server/mesh/cell.hpp"

#include <algorithm>
#include <cmath>

namespace earthwork::mesh {
namespace {

constexpr std::int64_t kSide = voxel::kEdgeSteps;

/// A corner of the cell, 0 or 1 along either axis.
struct Corner {
  int x, y;
};
constexpr Corner kA{0, 0}, kB{1, 0}, kC{0, 1}, kD{1, 1};

enum class Shape : std::uint8_t { none, corner, open, diagonal };

/// The contour of a case: from where to where, with filled ground on the left.
struct Case {
  Shape shape;
  Side from, to;
  Corner corner;
};
constexpr std::array<Case, 16> kCases{{
    {Shape::none, kBottom, kBottom, kA},
    {Shape::corner, kBottom, kLeft, kA},
    {Shape::corner, kRight, kBottom, kB},
    {Shape::open, kRight, kLeft, kA},
    {Shape::corner, kLeft, kTop, kC},
    {Shape::open, kBottom, kTop, kA},
    {Shape::diagonal, kBottom, kBottom, kB},
    {Shape::open, kRight, kTop, kA},
    {Shape::corner, kTop, kRight, kD},
    {Shape::diagonal, kBottom, kBottom, kA},
    {Shape::open, kTop, kBottom, kA},
    {Shape::open, kTop, kLeft, kA},
    {Shape::open, kLeft, kRight, kA},
    {Shape::open, kBottom, kRight, kA},
    {Shape::open, kLeft, kBottom, kA},
    {Shape::none, kBottom, kBottom, kA},
}};

Hit hit(Side side, const CellHits& hits) { return {place(side, hits[side]), hits[side].normal}; }

inline std::optional<CellPoint> meeting(Side a, Side b, const CellHits& hits, std::int64_t limit) {
  if (!sharp(hits[a].normal, hits[b].normal, limit)) return std::nullopt;
  return feature_point(hit(a, hits), hit(b, hits), limit);
}

bool inside(CellPoint p) { return 0 < p.x && p.x < kSide && 0 < p.y && p.y < kSide; }

/// Distance from the corner into the cell along one axis.
std::int64_t into(int corner, std::int64_t p) { return corner == 0 ? p : kSide - p; }

struct CornerFeature {
  std::optional<CellPoint> point;
  bool clamped = false;
};

CornerFeature corner_feature(Corner corner, Side a, Side b, const CellHits& hits,
                             std::int64_t limit) {
  const auto p = meeting(a, b, hits, limit);
  if (!p) return {};
  const std::int64_t x = into(corner.x, p->x), y = into(corner.y, p->y);
  if (x <= 0 || y <= 0) return {};
  const auto clamp = [](std::int64_t v) { return std::clamp<std::int64_t>(v, 1, kSide - 1); };
  return {CellPoint{clamp(p->x), clamp(p->y)}, x > kSide || y > kSide};
}

/// p lies to the right of the line from u to v.
bool below(CellPoint p, CellPoint u, CellPoint v) {
  return (v.x - u.x) * (p.y - u.y) - (v.y - u.y) * (p.x - u.x) < 0;
}

/// A diagonal case named by its sides: the first corner lies between `ax` and `by`, the second
/// between `cx` and `ay`. Case 9 is case 6 turned a quarter to the left.
struct Diagonal {
  Side ax, by, cx, ay;
  Corner first, second;
};
constexpr Diagonal kCase6{kBottom, kRight, kTop, kLeft, kB, kC};
constexpr Diagonal kCase9{kRight, kTop, kLeft, kBottom, kD, kA};

bool joined(const Diagonal& at, const CellHits& hits, const std::optional<CellPoint>& p1,
            const std::optional<CellPoint>& p2) {
  const CellPoint ax = place(at.ax, hits[at.ax]), by = place(at.by, hits[at.by]);
  const CellPoint cx = place(at.cx, hits[at.cx]), ay = place(at.ay, hits[at.ay]);
  if (p1 && p2) {
    return below(*p2, ax, *p1) ? below(*p2, *p1, by) || below(*p1, *p2, ay)
                               : below(*p2, *p1, by) && below(*p1, cx, *p2);
  }
  if (p1) return below(*p1, cx, ay);
  if (p2) return below(*p2, ax, by);
  return false;
}

/// The distance of p from the diagonal between the filled corners, positive on the side of the
/// empty corner between `ax` and `ay`.
std::int64_t off_diagonal(const Diagonal& at, CellPoint p) {
  return at.ax == kBottom ? kSide - p.x - p.y : p.x - p.y;
}

/// A half of a joined cell; `sign` says on which side of the diagonal it lies.
Piece half(const Diagonal& at, Side from, Side to, int sign, const CellHits& hits,
           std::int64_t limit) {
  Piece piece{from, to, meeting(from, to, hits, limit)};
  if (piece.feature && (!inside(*piece.feature) || sign * off_diagonal(at, *piece.feature) <= 0)) {
    piece.feature.reset();
  }
  return piece;
}

CellContour diagonal(const Diagonal& at, const CellHits& hits, std::int64_t limit) {
  const CornerFeature p1 = corner_feature(at.first, at.ax, at.by, hits, limit);
  const CornerFeature p2 = corner_feature(at.second, at.cx, at.ay, hits, limit);
  if (joined(at, hits, p1.point, p2.point)) {
    return {2,
            {half(at, at.ay, at.ax, 1, hits, limit), half(at, at.by, at.cx, -1, hits, limit)},
            true,
            0};
  }
  return {2,
          {Piece{at.by, at.ax, p1.point}, Piece{at.ay, at.cx, p2.point}},
          false,
          int{p1.clamped} + int{p2.clamped}};
}

CellContour around_corner(const Case& c, const CellHits& hits, std::int64_t limit) {
  const CornerFeature feature = corner_feature(c.corner, c.from, c.to, hits, limit);
  return {1, {Piece{c.from, c.to, feature.point}, {}}, false, int{feature.clamped}};
}

CellContour across(const Case& c, const CellHits& hits, std::int64_t limit) {
  const auto p = meeting(c.from, c.to, hits, limit);
  return {1, {Piece{c.from, c.to, p && inside(*p) ? p : std::nullopt}, {}}, false, 0};
}

std::int64_t cross(CellPoint p, CellPoint q) { return p.x * q.y - p.y * q.x; }

/// The filled part of the side from corner `u` to corner `v`, cut at `at`, seen from the origin.
std::int64_t twice_side_area(CellPoint u, bool u_filled, CellPoint v, bool v_filled, CellPoint at) {
  if (u_filled) return cross(u, v_filled ? v : at);
  return v_filled ? cross(at, v) : 0;
}

}  // namespace

CellPoint place(Side side, voxel::Crossing crossing) {
  switch (side) {
    case kBottom:
      return {crossing.offset, 0};
    case kRight:
      return {kSide, crossing.offset};
    case kTop:
      return {crossing.offset, kSide};
    case kLeft:
      break;
  }
  return {0, crossing.offset};
}

// The cosine is rounded to a billionth, so that builds whose libraries disagree in its last bit
// agree here, but for about one angle in ten million.
std::int64_t sharpness_limit(double max_feature_angle_degrees) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kUnit = double{voxel::kNormalUnit} * voxel::kNormalUnit;
  return std::llround(kUnit * (std::cos(max_feature_angle_degrees * kPi / 180) - 1e-4));
}

// Each of these builds its result where the caller wants it: a copy would cost more than the cell.
CellContour contour(unsigned cell_case, const CellHits& hits, std::int64_t limit) {
  const Case& c = kCases[cell_case];
  switch (c.shape) {
    case Shape::corner:
      return around_corner(c, hits, limit);
    case Shape::open:
      return across(c, hits, limit);
    case Shape::diagonal:
      return diagonal(cell_case == 6 ? kCase6 : kCase9, hits, limit);
    case Shape::none:
      break;
  }
  return {};
}

// Green's theorem: the pieces, and the filled parts of the sides, each counter-clockwise.
std::int64_t twice_cell_area(unsigned cell_case, const CellHits& hits, const CellContour& contour) {
  std::int64_t sum = 0;
  for (int k = 0; k < contour.count; ++k) {
    const Piece& piece = contour.pieces[static_cast<std::size_t>(k)];
    const CellPoint from = place(piece.from, hits[piece.from]),
                    to = place(piece.to, hits[piece.to]);
    sum +=
        piece.feature ? cross(from, *piece.feature) + cross(*piece.feature, to) : cross(from, to);
  }
  constexpr std::array<CellPoint, 4> kRound{{{0, 0}, {kSide, 0}, {kSide, kSide}, {0, kSide}}};
  const std::array<bool, 4> filled{(cell_case & 1) != 0, (cell_case & 2) != 0, (cell_case & 8) != 0,
                                   (cell_case & 4) != 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    const Side side = static_cast<Side>(k);
    sum += twice_side_area(kRound[k], filled[k], kRound[next], filled[next], place(side, hits[k]));
  }
  return sum;
}

}  // namespace earthwork::mesh
