// One cell at a time: the sixteen cases, and the symmetries that the rules must have.
#include "server/mesh/cell.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace earthwork::mesh {
namespace {

constexpr std::int64_t kLimit = -759'311'152;  // 135 degrees
constexpr std::int64_t kFull = 2ll * 32768 * 32768;

/// Crossings in the middle of every side, normals along the sides.
CellHits straight(voxel::Normal bottom, voxel::Normal right, voxel::Normal top,
                  voxel::Normal left) {
  return {{{16384, bottom}, {16384, right}, {16384, top}, {16384, left}}};
}
constexpr voxel::Normal kRight{32767, 0}, kUp{0, 32767}, kLeft{-32767, 0}, kDown{0, -32767};

/// A quarter turn to the left of a cell: what was at the bottom is at the right.
unsigned turned(unsigned c) {
  const unsigned a = c & 1, b = c >> 1 & 1, cc = c >> 2 & 1, d = c >> 3 & 1;
  return cc | a << 1 | d << 2 | b << 3;
}
CellHits turned(const CellHits& hits) {
  const auto turn = [](voxel::Normal n) {
    return voxel::Normal{static_cast<std::int16_t>(-n.y), n.x};
  };
  const auto same = [&](voxel::Crossing c) { return voxel::Crossing{c.offset, turn(c.normal)}; };
  const auto back = [&](voxel::Crossing c) {
    return voxel::Crossing{static_cast<std::uint16_t>(32768 - c.offset), turn(c.normal)};
  };
  return {
      {back(hits[Side::kLeft]), same(hits[kBottom]), back(hits[Side::kRight]), same(hits[kTop])}};
}

rc::Gen<voxel::Normal> any_normal() {
  return rc::gen::map(rc::gen::inRange(0, 3600), [](int tenth) {
    const double angle = tenth * 3.14159265358979 / 1800;
    return voxel::Normal{static_cast<std::int16_t>(std::lround(32767 * std::cos(angle))),
                         static_cast<std::int16_t>(std::lround(32767 * std::sin(angle)))};
  });
}
rc::Gen<CellHits> any_hits() {
  return rc::gen::exec([] {
    CellHits hits;
    for (voxel::Crossing& hit : hits) {
      hit.offset = static_cast<std::uint16_t>(*rc::gen::inRange(1, 32768));
      hit.normal = *any_normal();
    }
    return hits;
  });
}

TEST(Contour, HasAsManyPiecesAsTheCaseAsks) {
  const CellHits hits = straight(kRight, kUp, kRight, kUp);
  constexpr int kPieces[16] = {0, 1, 1, 1, 1, 1, 2, 1, 1, 2, 1, 1, 1, 1, 1, 0};
  for (unsigned c = 0; c < 16; ++c) EXPECT_EQ(contour(c, hits, kLimit).count, kPieces[c]) << c;
}

TEST(Contour, OfASquaresCornerHasTheCorner) {
  const CellHits hits = straight(kRight, kUp, kRight, kUp);
  const CellContour corner = contour(1, hits, kLimit);
  EXPECT_EQ(corner.pieces[0].from, kBottom);
  EXPECT_EQ(corner.pieces[0].to, Side::kLeft);
  EXPECT_EQ(corner.pieces[0].feature, (CellPoint{16384, 16384}));
  EXPECT_EQ(twice_cell_area(1, hits, corner), kFull / 4);
}

TEST(Contour, OfARoundCornerHasNone) {
  const CellHits hits = straight({23170, 23170}, {}, {}, {23170, 23170});
  const CellContour corner = contour(1, hits, kLimit);
  EXPECT_EQ(corner.pieces[0].feature, std::nullopt);
  EXPECT_EQ(twice_cell_area(1, hits, corner), kFull / 8);
}

TEST(Contour, OfAHalfIsAHalf) {
  const CellHits hits = straight({}, kUp, {}, kUp);
  EXPECT_EQ(twice_cell_area(3, hits, contour(3, hits, kLimit)), kFull / 2);
  EXPECT_EQ(twice_cell_area(12, hits, contour(12, hits, kLimit)), kFull / 2);
}

TEST(Contour, CornersWithoutFeaturesStayApart) {
  const CellHits hits =
      straight({-23170, 23170}, {-23170, 23170}, {23170, -23170}, {23170, -23170});
  const CellContour apart = contour(6, hits, kLimit);
  EXPECT_FALSE(apart.connected);
  EXPECT_EQ(twice_cell_area(6, hits, apart), kFull / 4);
}

TEST(Contour, ACornerThatReachesAcrossIsJoined) {
  // The tangents of b meet at (2048, 30720), beyond the line of c from (8192, 32768) to (0, 24576).
  const CellHits hits{{{24576, kLeft}, {8192, kUp}, {8192, kDown}, {24576, kRight}}};
  CellHits reaching = hits;
  reaching[kBottom] = {2048, kLeft};
  reaching[Side::kRight] = {30720, kUp};
  const CellContour joined = contour(6, reaching, kLimit);
  EXPECT_TRUE(joined.connected);
  EXPECT_EQ(joined.pieces[0].from, Side::kLeft);
  EXPECT_EQ(joined.pieces[0].to, kBottom);
}

TEST(Contour, AClampedFeatureIsCounted) {
  // Case 1 with tangents that meet far to the right of the cell.
  const CellHits hits{{{30000, {32767, 0}}, {}, {}, {30000, {8000, 31775}}}};
  CellHits far = hits;
  far[kBottom].normal = {23170, -23170};
  const CellContour corner = contour(1, far, kLimit);
  ASSERT_TRUE(corner.pieces[0].feature.has_value());
  EXPECT_LT(corner.pieces[0].feature->x, 32768);
  EXPECT_EQ(corner.clamped_features, 1);
}

RC_GTEST_PROP(Contour, IsTheSameSeenFromAQuarterTurn, ()) {
  const CellHits hits = *any_hits();
  const unsigned c = *rc::gen::inRange(1u, 15u);
  const CellContour one = contour(c, hits, kLimit);
  const CellContour other = contour(turned(c), turned(hits), kLimit);
  RC_ASSERT(one.connected == other.connected);
  RC_ASSERT(one.clamped_features == other.clamped_features);
  RC_ASSERT(one.count == other.count);
}

RC_GTEST_PROP(Contour, FeaturesLieInsideTheCell, ()) {
  const CellHits hits = *any_hits();
  const CellContour found = contour(*rc::gen::inRange(1u, 15u), hits, kLimit);
  for (int k = 0; k < found.count; ++k) {
    const auto& feature = found.pieces[static_cast<std::size_t>(k)].feature;
    if (!feature) continue;
    RC_ASSERT(0 < feature->x && feature->x < 32768 && 0 < feature->y && feature->y < 32768);
  }
}

// A case and its opposite with normals turned about share one contour unless a corner's rule (drop
// or clamp) is not the open one (keep inside): without features the two areas fill the cell.
RC_GTEST_PROP(Contour, OppositeCasesFillTheCell, ()) {
  const CellHits hits = *any_hits();
  const unsigned c = *rc::gen::element(1u, 2u, 3u, 4u, 5u, 8u);
  const CellContour one = contour(c, hits, kLimit), other = contour(15 - c, hits, kLimit);
  RC_PRE(!one.pieces[0].feature && !other.pieces[0].feature);
  RC_ASSERT(twice_cell_area(c, hits, one) + twice_cell_area(15 - c, hits, other) == kFull);
}

TEST(SharpnessLimit, IsInSquaredNormalUnits) {
  EXPECT_EQ(sharpness_limit(135), kLimit);
  EXPECT_EQ(sharpness_limit(90), -107368);
}

}  // namespace
}  // namespace earthwork::mesh
