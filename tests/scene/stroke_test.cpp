// Strokes: no gap however the brush is drawn, no edit that a server would refuse.
#include "client/scene/stroke.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::scene {
namespace {

using protocol::Edit;
using protocol::MapPoint;
using protocol::MapSettings;
using protocol::StencilShape;
using std::chrono::seconds;

constexpr Stroke::Time kNow{};

std::vector<MapPoint> stamps_of(const std::vector<Edit>& edits) {
  std::vector<MapPoint> stamps;
  for (const Edit& edit : edits) stamps.insert(stamps.end(), edit.path.begin(), edit.path.end());
  return stamps;
}

/// All stamps of a drag along the points.
std::vector<MapPoint> drag(const BrushSettings& brush, const std::vector<MapPoint>& way,
                           const MapSettings& settings = {}) {
  Stroke stroke(brush, settings, 1, way.front(), kNow);
  for (std::size_t i = 1; i < way.size(); ++i) stroke.draw_to(way[i], kNow);
  stroke.finish(kNow);
  return stamps_of(stroke.take());
}

void expect_stamps(const std::vector<MapPoint>& stamps, const std::vector<MapPoint>& expected) {
  ASSERT_EQ(stamps.size(), expected.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    EXPECT_NEAR(stamps[i].x, expected[i].x, 1e-9) << i;
    EXPECT_NEAR(stamps[i].y, expected[i].y, 1e-9) << i;
  }
}

TEST(Stroke, HandsOutItsFirstStampAtOnce) {
  const BrushSettings brush{
      .stencil = StencilShape::square, .fill = false, .radius_voxels = 2.5, .layer = 1};
  MapSettings settings;
  settings.voxel_size = 2;
  settings.layers.resize(2);
  Stroke stroke(brush, settings, 7, {3, 4}, kNow);
  const Edit expected{.layer = 1,
                      .stencil = StencilShape::square,
                      .fill = false,
                      .radius = 5,
                      .path = {{3, 4}},
                      .is_path = true,
                      .stroke = 7};
  EXPECT_EQ(stroke.take(), std::vector<Edit>{expected});
  EXPECT_EQ(stroke.take(), std::vector<Edit>{});
  EXPECT_EQ(stroke.next_number(), 8);
}

TEST(Stroke, StampsAQuarterOfTheRadiusApart) {
  Stroke stroke({.radius_voxels = 4}, {}, 1, {0, 0}, kNow);
  stroke.draw_to({0.75, 0}, kNow);
  stroke.draw_to({2.5, 0}, kNow);
  expect_stamps(stamps_of(stroke.take()), {{0, 0}, {1, 0}, {2, 0}});
  stroke.draw_to({2.5, 0.75}, kNow);
  expect_stamps(stamps_of(stroke.take()), {{2.5, 0.5}});
}

TEST(Stroke, StampsNoCloserThanHalfAVoxel) {
  expect_stamps(drag({.radius_voxels = 1}, {{0, 0}, {1.5, 0}}),
                {{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}});
}

TEST(Stroke, EndsWhereTheBrushIsLifted) {
  Stroke stroke({.radius_voxels = 4}, {}, 1, {0, 0}, kNow);
  stroke.draw_to({0.75, 0}, kNow);
  stroke.finish(kNow);
  stroke.finish(kNow);
  expect_stamps(stamps_of(stroke.take()), {{0, 0}, {0.75, 0}});
}

TEST(Stroke, OfAPressIsOneStamp) {
  EXPECT_EQ(drag({}, {{1, 2}}).size(), 1u);
  EXPECT_EQ(drag({}, {{1, 2}, {1, 2}, {1, 2}}).size(), 1u);
}

TEST(Stroke, SnappedStampsEveryPlaceOnTheWay) {
  const BrushSettings centres{.radius_voxels = 5, .snap = Snap::centres};
  expect_stamps(drag(centres, {{0.2, 0.2}, {2.9, 0.8}}), {{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}});
  const BrushSettings lines{.radius_voxels = 5, .snap = Snap::lines};
  expect_stamps(drag(lines, {{0.2, 0.2}, {1.9, 0.8}}), {{0, 0}, {1, 0}, {1, 1}, {2, 1}});
}

TEST(Stroke, SnappedStampsAPlaceOnceInARow) {
  const BrushSettings brush{.radius_voxels = 0};
  expect_stamps(drag(brush, {{0.2, 0.2}, {0.7, 0.3}, {0.9, 0.9}}), {{0.5, 0.5}});
  expect_stamps(drag(brush, {{0.2, 0.2}, {1.2, 0.2}, {0.8, 0.2}}),
                {{0.5, 0.5}, {1.5, 0.5}, {0.5, 0.5}});
}

TEST(Stroke, GoesBackAcrossVoxelsLeftAndDown) {
  expect_stamps(drag({.radius_voxels = 0}, {{0.5, 0.5}, {-1.5, -0.6}}),
                {{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {-1.5, -0.5}});
}

TEST(Stroke, OfManyStampsGoesOnUnderTheNextNumber) {
  Stroke stroke({.radius_voxels = 4}, {}, 5, {0, 0}, kNow);
  stroke.draw_to({4096, 0}, kNow);
  const auto edits = stroke.take();
  ASSERT_EQ(edits.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(edits[i].path.size(), 1024u);
    EXPECT_EQ(edits[i].stroke, 5);
  }
  EXPECT_EQ(edits[4].path, (std::vector<MapPoint>{{4096, 0}}));
  EXPECT_EQ(edits[4].stroke, 6);
  EXPECT_EQ(stroke.next_number(), 7);
}

TEST(Stroke, OfAMinuteGoesOnUnderTheNextNumber) {
  Stroke stroke({.radius_voxels = 4}, {}, 5, {0, 0}, kNow);
  stroke.draw_to({1, 0}, kNow + seconds(59));
  stroke.draw_to({2, 0}, kNow + seconds(60));
  stroke.draw_to({3, 0}, kNow + seconds(119));
  stroke.draw_to({4, 0}, kNow + seconds(120));
  const auto edits = stroke.take();
  ASSERT_EQ(edits.size(), 3u);
  EXPECT_EQ(edits[0].stroke, 5);
  EXPECT_EQ(edits[1].stroke, 6);
  EXPECT_EQ(edits[1].path.size(), 2u);
  EXPECT_EQ(edits[2].stroke, 7);
}

TEST(Stroke, LeavesOutWhatLiesOutsideTheWorld) {
  const auto stamps = drag({.radius_voxels = 4}, {{999'998, 0}, {1'000'003, 0}, {999'999, 0}});
  ASSERT_EQ(stamps.size(), 5u);
  for (const MapPoint& at : stamps) EXPECT_LE(at.x, 1e6);
  EXPECT_TRUE(drag({.radius_voxels = 4}, {{1e7, 0}, {1e7, 100}}).empty());
  EXPECT_TRUE(drag({.radius_voxels = 0}, {{1e7, 0}, {1e7, 100}}).empty());
}

TEST(Stroke, LeavesOutWhatCannotReachABoundedMap) {
  MapSettings settings;
  settings.chunks = {0, 0, 1, 1};  // 32 x 32 voxels
  const auto stamps = drag({.radius_voxels = 4}, {{-1000, 10}, {1000, 10}}, settings);
  ASSERT_FALSE(stamps.empty());
  EXPECT_GE(stamps.front().x, -5);
  EXPECT_LT(stamps.front().x, -3);
  EXPECT_LE(stamps.back().x, 37);
  EXPECT_GT(stamps.back().x, 35);
  EXPECT_TRUE(drag({.radius_voxels = 4}, {{-100, 10}, {-100, 20}}, settings).empty());
}

TEST(Stroke, OfALargeBrushOnSmallChunksIsSplitIntoMoreEdits) {
  MapSettings settings;
  settings.chunk_resolution = 8;
  Stroke stroke({.radius_voxels = 50}, settings, 1, {0, 0}, kNow);
  stroke.draw_to({10'000, 10'000}, kNow);
  const auto edits = stroke.take();
  EXPECT_GE(edits.size(), 5u);
  EXPECT_LE(edits.size(), 12u);
  for (const Edit& edit : edits) EXPECT_TRUE(protocol::check_edit(edit, settings));
}

TEST(Stroke, OfALayerThatIsNotThereIsNothing) {
  EXPECT_TRUE(drag({.layer = 1}, {{0, 0}, {10, 0}}).empty());
}

TEST(Stroke, IsNotMovedByWhatIsNoPlace) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Stroke stroke({.radius_voxels = 4}, {}, 1, {0, 0}, kNow);
  for (const double bad : {nan, infinity, -infinity, 1e300, 2e12}) stroke.draw_to({bad, 0}, kNow);
  stroke.draw_to({1, 0}, kNow);
  expect_stamps(stamps_of(stroke.take()), {{0, 0}, {1, 0}});
  EXPECT_TRUE(drag({.radius_voxels = 4}, {{nan, 0}, {nan, 1}}).empty());
  EXPECT_EQ(drag({.radius_voxels = 4}, {{infinity, 0}, {1, 0}, {2, 0}}).size(), 1u);
}

TEST(Stroke, AcrossTheWorldIsBounded) {
  for (const Snap snap : {Snap::none, Snap::centres, Snap::lines}) {
    const BrushSettings brush{.radius_voxels = 0.5, .snap = snap};
    const auto stamps = drag(brush, {{-1e12, -9e11}, {1e12, 9e11}});
    EXPECT_LE(stamps.size(), 100'003u);
    EXPECT_GE(stamps.size(), 50'000u);
    for (const MapPoint& at : stamps) {
      ASSERT_LE(std::max(std::abs(at.x), std::abs(at.y)), 1e6);
      ASSERT_NEAR(at.y, 0.9 * at.x, 1);
    }
  }
}

TEST(Stroke, AFullEditFitsIntoAMessage) {
  MapSettings settings;
  settings.voxel_size = 1.0 / 3e5;
  Stroke stroke({.radius_voxels = 1.0 / 3}, settings, (std::int64_t{1} << 53) - 1,
                {-1.0 / 3, -1.0 / 7}, kNow);
  stroke.draw_to({-2.0 / 3, -3.0 / 7}, kNow);
  const auto edits = stroke.take();
  ASSERT_EQ(edits.front().path.size(), protocol::kMaxPathPoints);
  const auto text = protocol::write(protocol::ClientMessage(
      protocol::EditMessage{.id = (std::int64_t{1} << 53) - 1, .edit = edits.front()}));
  EXPECT_LE(text.size(), protocol::kMaxControlBytes);
}

MapSettings any_settings() {
  MapSettings settings;
  settings.chunk_resolution = *rc::gen::element(8, 16, 32, 64);
  settings.voxel_size = *rc::gen::element(1e-6, 0.3, 1.0, 7.7, 1e6);
  return settings;
}

BrushSettings any_brush() {
  BrushSettings brush;
  brush.stencil = *rc::gen::element(StencilShape::square, StencilShape::circle);
  brush.radius_voxels = *rc::gen::element(0.0, 0.3, 0.5, 1.0, 2.5, 20.0, 50.0);
  brush.snap = *rc::gen::element(Snap::none, Snap::centres, Snap::lines);
  return brush;
}

/// A few points; the reach of the drag in voxels.
std::vector<MapPoint> any_way(double voxel_size, double reach) {
  std::vector<MapPoint> way;
  const int points = *rc::gen::inRange(1, 8);
  const auto coordinate = [&] { return *rc::gen::inRange(-1000, 1001) / 1000.0; };
  for (int i = 0; i < points; ++i)
    way.push_back({coordinate() * reach * voxel_size, coordinate() * reach * voxel_size});
  return way;
}

RC_GTEST_PROP(Stroke, EveryEditPasses, ()) {
  const MapSettings settings = any_settings();
  const auto way = any_way(settings.voxel_size, *rc::gen::element(10.0, 3000.0, 1.1e6));
  Stroke stroke(any_brush(), settings, 1, way.front(), kNow);
  for (const MapPoint& at : way) stroke.draw_to(at, kNow);
  stroke.finish(kNow);
  std::int64_t number = 1;
  std::size_t stamps = 0;
  for (const Edit& edit : stroke.take()) {
    RC_ASSERT(protocol::check_edit(edit, settings).has_value());
    RC_ASSERT(!edit.path.empty());
    RC_ASSERT(edit.path.size() <= protocol::kMaxPathPoints);
    RC_ASSERT(edit.stroke.value() >= number);
    if (*edit.stroke > number) stamps = 0;
    stamps += edit.path.size();
    RC_ASSERT(stamps <= 4096u);
    number = *edit.stroke;
  }
  RC_ASSERT(stroke.next_number() == number + 1);
}

/// How far `at` is from the nearest stamp, as the stencil measures.
double distance(StencilShape stencil, MapPoint at, const std::vector<MapPoint>& stamps) {
  double nearest = 1e300;
  for (const MapPoint& stamp : stamps) {
    const double dx = std::abs(at.x - stamp.x), dy = std::abs(at.y - stamp.y);
    nearest =
        std::min(nearest, stencil == StencilShape::circle ? std::hypot(dx, dy) : std::max(dx, dy));
  }
  return nearest;
}

RC_GTEST_PROP(Stroke, LeavesNoGap, ()) {
  BrushSettings brush = any_brush();
  brush.snap = Snap::none;
  if (brush.radius_voxels < 0.5) brush.radius_voxels = 0.75;
  const double size = *rc::gen::element(1e-3, 1.0, 7.0), radius = brush.radius_voxels * size;
  MapSettings settings;
  settings.voxel_size = size;
  const auto way = any_way(size, 60);
  const auto stamps = drag(brush, way, settings);
  const double spacing = std::max(radius / 4, size / 2);
  for (std::size_t i = 0; i + 1 < way.size(); ++i)
    for (int k = 0; k <= 50; ++k) {
      const double share = k / 50.0;
      const MapPoint at{way[i].x + (way[i + 1].x - way[i].x) * share,
                        way[i].y + (way[i + 1].y - way[i].y) * share};
      RC_ASSERT(distance(brush.stencil, at, stamps) <= spacing / 2 * (1 + 1e-9));
    }
  RC_ASSERT(stamps.back() == way.back() || way.back() == way.front());
}

RC_GTEST_PROP(Stroke, PaintsTheWholeWidthOfAStraightDrag, ()) {
  const double radius = *rc::gen::element(0.5, 1.0, 3.0, 20.0);
  const auto way = any_way(1, 60);
  const MapPoint a = way.front(), b = way.back();
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (length == 0) return;
  const auto stamps = drag({.radius_voxels = radius}, {a, b});
  const double spacing = std::max(radius / 4, 0.5);
  const double width = std::sqrt(radius * radius - spacing * spacing / 4);  // up to the scallop
  for (int k = 0; k <= 100; ++k)
    for (const double side : {-width, width}) {
      const MapPoint rim{a.x + (b.x - a.x) * k / 100 - (b.y - a.y) / length * side,
                         a.y + (b.y - a.y) * k / 100 + (b.x - a.x) / length * side};
      RC_ASSERT(distance(StencilShape::circle, rim, stamps) <= radius * (1 + 1e-9));
    }
}

RC_GTEST_PROP(Stroke, OfAPointStampsEveryVoxelOnItsWay, ()) {
  const double size = *rc::gen::element(1e-6, 0.5, 1.0, 1e6);
  MapSettings settings;
  settings.voxel_size = size;
  const auto way = any_way(size, 40);
  const auto stamps = drag({.radius_voxels = 0}, way, settings);
  const auto voxel = [&](MapPoint at) {
    return std::pair(std::floor(at.x / size), std::floor(at.y / size));
  };
  std::set<std::pair<double, double>> painted;
  for (const MapPoint& at : stamps) painted.insert(voxel(at));
  for (std::size_t i = 0; i + 1 < way.size(); ++i)
    for (int k = 0; k <= 400; ++k) {
      const double share = k / 400.0;
      const MapPoint at{way[i].x + (way[i + 1].x - way[i].x) * share,
                        way[i].y + (way[i + 1].y - way[i].y) * share};
      const double to_side = std::min(std::abs(at.x / size - std::round(at.x / size)),
                                      std::abs(at.y / size - std::round(at.y / size)));
      if (to_side > 1e-6) RC_ASSERT(painted.contains(voxel(at)));
    }
  for (std::size_t i = 0; i + 1 < stamps.size(); ++i)
    RC_ASSERT(std::abs(std::abs(stamps[i].x - stamps[i + 1].x) +
                       std::abs(stamps[i].y - stamps[i + 1].y) - size) < 1e-6 * size);
}

}  // namespace
}  // namespace earthwork::scene
