// The camera: that the map and the screen are told apart rightly, wherever the map lies and however
// large its voxels are.
#include "client/scene/camera.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/limits.hpp"

namespace earthwork::scene {
namespace {

using protocol::MapPoint;
using protocol::MapRect;

constexpr double kPi = std::numbers::pi;

Camera camera_at(Camera::Place place, ScreenSize size = {800, 600}) {
  Camera camera;
  camera.resize(size);
  camera.set(place);
  return camera;
}

/// 0 .. 1.
double share() { return *rc::gen::inRange(0, 1'000'001) / 1e6; }
double between(double low, double high) { return low + (high - low) * share(); }

/// Any camera on any map, far from 0 as well.
Camera any_camera() {
  Camera camera;
  const double voxel_size = std::pow(10, *rc::gen::inRange(-6, 7));
  camera.set_voxel_size(voxel_size);
  camera.resize({between(1, 3000), between(1, 2000)});
  camera.set({.target = {between(-1e6, 1e6) * voxel_size, between(-1e6, 1e6) * voxel_size},
              .zoom = std::pow(10, between(-3.5, 2.6)) / voxel_size,
              .yaw = between(-kPi, kPi),
              .tilt = between(0, kMaxTilt)});
  return camera;
}

/// Of the world, in map units.
double world_end(Camera camera) {
  camera.set({.target = {1e300, 0}});
  return camera.place().target.x;
}

/// Any camera that sees no end of the world.
Camera any_camera_inland() {
  Camera camera = any_camera();
  // Wide pictures show more of it to the sides.
  const auto [width, height] = camera.size();
  const double furthest = world_end(camera) / 200 / std::max(1.0, width / height);
  Camera::Place place = camera.place();
  place.target = {place.target.x / 100, place.target.y / 100};
  place.zoom = std::max(place.zoom, place.zoom * camera.distance() / furthest);
  camera.set(place);
  return camera;
}

ScreenPoint any_point(const Camera& camera) {
  return {camera.size().width * share(), camera.size().height * share()};
}

/// CSS pixels that rounding of a coordinate may cost.
double pixel_error(const Camera& camera, const MapPoint& at) {
  const Camera::Place& place = camera.place();
  const double units = std::abs(place.target.x) + std::abs(place.target.y) + std::abs(at.x) +
                       std::abs(at.y) + camera.distance();
  // Near the eye, a 64th of the target's distance from it, everything is as much larger.
  return 64 * place.zoom * units * 1e-14;
}

/// Within what rounding may do to the coordinates of ground 30 times as far as the target, where a
/// ray meets it at half a degree.
bool is_near(const Camera& camera, const MapPoint& a, const MapPoint& b) {
  const double error = 1e-9 * camera.distance() + 1e-14 * (std::abs(b.x) + std::abs(b.y));
  return std::abs(a.x - b.x) < error && std::abs(a.y - b.y) < error;
}

void expect_near(const ScreenPoint& a, const ScreenPoint& b, double error) {
  EXPECT_NEAR(a.x, b.x, error);
  EXPECT_NEAR(a.y, b.y, error);
}

TEST(Camera, ShowsAMapUnitAsManyPixelsAsItsZoomWhenItLooksDown) {
  const Camera camera = camera_at({.target = {10, 20}, .zoom = 16});
  expect_near(camera.screen({10, 20, 0}).value(), {400, 300}, 1e-9);
  expect_near(camera.screen({11, 20, 0}).value(), {416, 300}, 1e-9);
  expect_near(camera.screen({10, 23, 0}).value(), {400, 252}, 1e-9);
  const auto corner = camera.ground({0, 0}).value();
  EXPECT_NEAR(corner.x, 10 - 25, 1e-9);
  EXPECT_NEAR(corner.y, 20 + 18.75, 1e-9);
}

TEST(Camera, HasAFieldOfView30DegreesHigh) {
  const Camera camera = camera_at({.target = {0, 0}, .zoom = 10});
  EXPECT_NEAR(camera.eye().z, 30 / std::tan(15 * kPi / 180), 1e-9);
  EXPECT_NEAR(camera.distance(), camera.eye().z, 1e-9);
}

TEST(Camera, YawTurnsWhatIsUpCounterClockwise) {
  const Camera camera = camera_at({.target = {0, 0}, .zoom = 10, .yaw = kPi / 2});
  expect_near(camera.screen({-1, 0, 0}).value(), {400, 290}, 1e-9);
  expect_near(camera.screen({0, 1, 0}).value(), {410, 300}, 1e-9);
}

TEST(Camera, TiltLooksTowardWhatIsUp) {
  const Camera camera = camera_at({.target = {0, 0}, .zoom = 10, .tilt = 1});
  EXPECT_NEAR(camera.eye().x, 0, 1e-9);
  EXPECT_NEAR(camera.eye().y, -camera.distance() * std::sin(1), 1e-9);
  EXPECT_NEAR(camera.eye().z, camera.distance() * std::cos(1), 1e-9);
  EXPECT_LT(camera.screen({0, 0, 1}).value().y, 300) << "heights rise on the screen";
}

TEST(Camera, KeepsItsPlaceWithinBounds) {
  const Camera camera =
      camera_at({.target = {3e6, -3e6}, .zoom = 1e9, .yaw = 3 * kPi / 2, .tilt = 2});
  EXPECT_EQ(camera.place().target, (MapPoint{1'000'576, -1'000'576}));
  EXPECT_EQ(camera.place().zoom, 400);
  EXPECT_NEAR(camera.place().yaw, -kPi / 2, 1e-12);
  EXPECT_EQ(camera.place().tilt, kMaxTilt);
  EXPECT_EQ(camera_at({.target = {}, .zoom = 0}).place().zoom, 600 / 4e6);
  EXPECT_EQ(camera_at({.target = {}, .tilt = -1}).place().tilt, 0);
}

TEST(Camera, KeepsWhatItHadInPlaceOfWhatIsNotFinite) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Camera camera = camera_at({.target = {1, 2}, .zoom = 3, .yaw = 0.5, .tilt = 0.25});
  const Camera::Place before = camera.place();
  camera.set({.target = {nan, infinity}, .zoom = nan, .yaw = infinity, .tilt = nan});
  camera.set_voxel_size(nan);
  camera.set_voxel_size(-1);
  camera.resize({infinity, nan});
  camera.pan({nan, 0}, {1, 1});
  camera.zoom_at({1, 1}, nan);
  camera.zoom_at({1, 1}, 0);
  camera.zoom_at({1, 1}, -2);
  camera.orbit(nan, infinity);
  camera.fit({nan, 0, 1, infinity});
  EXPECT_EQ(camera.place(), before);
  EXPECT_EQ(camera.size(), (ScreenSize{800, 600}));
  EXPECT_EQ(camera.ground({nan, 0}), std::nullopt);
  EXPECT_EQ(camera.screen({nan, 0, 0}), std::nullopt);
}

TEST(Camera, HasNoPictureSmallerThanAPixel) {
  Camera camera;
  camera.resize({0, -5});
  EXPECT_EQ(camera.size(), (ScreenSize{1, 1}));
}

TEST(Camera, SeesNothingBehindItself) {
  const Camera camera = camera_at({.target = {}, .zoom = 10, .tilt = 1});
  EXPECT_EQ(camera.screen({0, -1000, 0}), std::nullopt);
  EXPECT_EQ(camera.screen(camera.eye()), std::nullopt);
  EXPECT_EQ(camera.ground({400, 300}, camera.eye().z), std::nullopt);
  EXPECT_EQ(camera.ground({400, 300}, camera.eye().z + 1), std::nullopt);
  const auto below = camera.seen(camera.eye().z + 1, camera.eye().z + 2);
  EXPECT_NEAR(below.x0, camera.eye().x, 1e-6);
  EXPECT_NEAR(below.y1, camera.eye().y, 1e-6);
  EXPECT_FALSE(camera.sees({-1000, -1000, 1000, 1000}, camera.eye().z + 1, camera.eye().z + 2));
}

TEST(Camera, LooksDownAgain) {
  Camera camera = camera_at({.target = {1, 2}, .zoom = 3, .yaw = 0.5, .tilt = 0.25});
  camera.look_down();
  EXPECT_EQ(camera.place(), (Camera::Place{.target = {1, 2}, .zoom = 3, .yaw = 0, .tilt = 0}));
}

TEST(Camera, OrbitsAboutItsTarget) {
  Camera camera = camera_at({.target = {1, 2}, .zoom = 3});
  camera.orbit(0.5, 0.75);
  EXPECT_EQ(camera.place(), (Camera::Place{.target = {1, 2}, .zoom = 3, .yaw = 0.5, .tilt = 0.75}));
  expect_near(camera.screen({1, 2, 0}).value(), {400, 300}, 1e-9);
  camera.orbit(2 * kPi, -5);
  EXPECT_NEAR(camera.place().yaw, 0.5, 1e-12);
  EXPECT_EQ(camera.place().tilt, 0);
}

TEST(Camera, DragsBeyondTheHorizonDoNothing) {
  Camera camera = camera_at({.target = {1, 2}, .zoom = 3, .tilt = kMaxTilt});
  const Camera::Place before = camera.place();
  ASSERT_TRUE(camera.ground({400, -9}));  // but hardly
  camera.pan({400, 300}, {400, -9});
  EXPECT_EQ(camera.place(), before);
  camera.pan({400, 300}, {400, -400});
  EXPECT_EQ(camera.place(), before);
}

RC_GTEST_PROP(Camera, FindsOnTheScreenTheGroundThatIsThere, ()) {
  const Camera camera = any_camera();
  const ScreenPoint at = any_point(camera);
  const double height = camera.eye().z * between(-2, 0.8);
  const auto ground = camera.ground(at, height);
  RC_ASSERT(ground.has_value());
  const auto back = camera.screen({ground->x, ground->y, height});
  RC_ASSERT(back.has_value());
  const double error = 1e-6 + pixel_error(camera, *ground);
  RC_ASSERT(std::abs(back->x - at.x) < error);
  RC_ASSERT(std::abs(back->y - at.y) < error);
}

RC_GTEST_PROP(Camera, ItsMatrixPutsAPointWhereTheScreenHasIt, ()) {
  const Camera camera = any_camera();
  const double d = camera.distance();
  const Vec3 relative{between(-1, 1) * d, between(-1, 1) * d, between(-1, 0.2) * d};
  const MapPoint& target = camera.place().target;
  const Vec3 point{target.x + relative.x, target.y + relative.y, relative.z};
  const auto clip = camera.clip_from_relative() * relative;
  const auto at = camera.screen(point);
  // Where it is too near to be drawn the near plane cuts it off.
  if (std::abs(clip[2] / clip[3] + 1) > 1e-3 && clip[3] > 0)
    RC_ASSERT(at.has_value() == (clip[2] > -clip[3]));
  if (!at) return;
  RC_ASSERT(clip[2] <= clip[3]);
  const double error = 1e-6 + pixel_error(camera, {point.x, point.y});
  RC_ASSERT(std::abs((clip[0] / clip[3] + 1) / 2 * camera.size().width - at->x) < error);
  RC_ASSERT(std::abs((1 - clip[1] / clip[3]) / 2 * camera.size().height - at->y) < error);
}

RC_GTEST_PROP(Camera, TellsDepthsApartWith24Bits, ()) {
  Camera camera = any_camera();
  camera.resize({2000, 2000});
  Camera::Place place = camera.place();
  place.tilt = 0;
  camera.set(place);
  const double step = 0.02 / camera.place().zoom;  // a 50th of a pixel
  const Mat4 clip = camera.clip_from_relative();
  const auto depth = [&](double height) {
    const auto at = clip * Vec3{0, 0, height};
    return std::floor((at[2] / at[3] + 1) / 2 * ((1 << 24) - 1));
  };
  RC_ASSERT(depth(-step) > depth(0));
  RC_ASSERT(depth(0) > depth(step));
}

RC_GTEST_PROP(Camera, PansTheGroundWithThePointer, ()) {
  Camera camera = any_camera_inland();
  const double zoom = camera.place().zoom;
  const ScreenPoint from = any_point(camera), to = any_point(camera);
  const MapPoint held = camera.ground(from).value();
  camera.pan(from, to);
  RC_ASSERT(is_near(camera, camera.ground(to).value(), held));
  RC_ASSERT(camera.place().zoom == zoom);
}

RC_GTEST_PROP(Camera, ZoomsAboutWhatIsUnderThePointer, ()) {
  Camera camera = any_camera_inland();
  const ScreenPoint at = any_point(camera);
  const MapPoint held = camera.ground(at).value();
  const double zoom = camera.place().zoom, factor = between(0.25, 4);
  camera.zoom_at(at, factor);
  RC_ASSERT(is_near(camera, camera.ground(at).value(), held));
  RC_ASSERT(camera.place().zoom <= zoom * std::max(factor, 1.0));
  RC_ASSERT(camera.place().zoom >= zoom * std::min(factor, 1.0));
}

TEST(Camera, ZoomsByTheFactorWithinItsBounds) {
  Camera camera = camera_at({.target = {0, 0}, .zoom = 16});
  camera.zoom_at({0, 0}, 2);
  EXPECT_EQ(camera.place().zoom, 32);
  camera.zoom_at({0, 0}, 1000);
  EXPECT_EQ(camera.place().zoom, 400);
  const MapPoint corner = camera.ground({0, 0}).value();
  EXPECT_NEAR(corner.x, -25, 1e-9);
  EXPECT_NEAR(corner.y, 18.75, 1e-9);
}

RC_GTEST_PROP(Camera, FitsARectangleWithAMargin, ()) {
  Camera camera = any_camera();
  const Camera::Place before = camera.place();
  const double end = world_end(camera);
  const MapRect rect{between(-end, 0), between(-end, 0), between(0, end), between(0, end)};
  camera.fit(rect);
  RC_ASSERT(camera.place().yaw == before.yaw);
  RC_ASSERT(camera.place().tilt == before.tilt);
  const auto [width, height] = camera.size();
  const double margin = 0.049 * std::min(width, height);
  double slack = width + height;  // of the corner that is nearest to an edge
  for (const double x : {rect.x0, rect.x1})
    for (const double y : {rect.y0, rect.y1}) {
      const auto at = camera.screen({x, y, 0});
      RC_ASSERT(at.has_value());
      slack = std::min({slack, at->x, width - at->x, at->y, height - at->y});
    }
  RC_ASSERT(slack >= margin);
  RC_ASSERT(slack <= 0.051 * std::min(width, height));
}

TEST(Camera, FitsAPoint) {
  Camera camera = camera_at({.target = {}, .tilt = 0.5});
  camera.fit({7, 8, 7, 8});
  EXPECT_EQ(camera.place().zoom, 400);
  EXPECT_NEAR(camera.place().target.x, 7, 1e-9);
  EXPECT_NEAR(camera.place().target.y, 8, 1e-9);
}

TEST(Camera, FitsTheWholeWorldHoweverItIsTurned) {
  constexpr double kEnd = protocol::kWorldVoxels;
  for (const ScreenSize size : {ScreenSize{800, 600}, {390, 844}, {2000, 100}})
    for (double tilt = 0; tilt <= kMaxTilt; tilt += 0.1)
      for (double yaw = 0; yaw < kPi; yaw += 0.1) {
        Camera camera = camera_at({.target = {}, .yaw = yaw, .tilt = tilt}, size);
        camera.fit({-kEnd, -kEnd, kEnd, kEnd});
        for (const double x : {-kEnd, kEnd})
          for (const double y : {-kEnd, kEnd}) {
            const ScreenPoint at = camera.screen({x, y, 0}).value();
            ASSERT_TRUE(at.x > 0 && at.x < size.width) << yaw << " " << tilt;
            ASSERT_TRUE(at.y > 0 && at.y < size.height) << yaw << " " << tilt;
          }
      }
}

RC_GTEST_PROP(Camera, AllGroundOnTheScreenIsSeen, ()) {
  const Camera camera = any_camera();
  const double eye = camera.eye().z;
  const double bottom = eye * between(-3, 0.5), top = bottom + eye * between(0, 2);
  const MapRect seen = camera.seen(bottom, top);
  const auto at = camera.ground(any_point(camera), between(bottom, std::min(top, eye * 0.9)));
  if (!at) return;
  RC_ASSERT(seen.x0 <= at->x);
  RC_ASSERT(at->x <= seen.x1);
  RC_ASSERT(seen.y0 <= at->y);
  RC_ASSERT(at->y <= seen.y1);
}

RC_GTEST_PROP(Camera, NoMoreIsSeenThanTheCornersShow, ()) {
  const Camera camera = any_camera();
  const double bottom = camera.eye().z * between(-3, 0.5);
  const double top = bottom + camera.eye().z * between(0, 0.4);
  const MapRect seen = camera.seen(bottom, top);
  MapRect corners{1e300, 1e300, -1e300, -1e300};
  for (const double x : {0.0, camera.size().width})
    for (const double y : {0.0, camera.size().height})
      for (const double height : {bottom, top}) {
        const MapPoint at = camera.ground({x, y}, height).value();
        corners = {std::min(corners.x0, at.x), std::min(corners.y0, at.y),
                   std::max(corners.x1, at.x), std::max(corners.y1, at.y)};
      }
  const double error = 1e-8 * camera.distance() + 1e-14 * (std::abs(seen.x0) + std::abs(seen.y0));
  RC_ASSERT(corners.x0 - seen.x0 < error);
  RC_ASSERT(corners.y0 - seen.y0 < error);
  RC_ASSERT(seen.x1 - corners.x1 < error);
  RC_ASSERT(seen.y1 - corners.y1 < error);
}

RC_GTEST_PROP(Camera, SeesEveryBoxWithAPointOnTheScreen, ()) {
  const Camera camera = any_camera();
  const double d = camera.distance(), eye = camera.eye().z;
  const double height = eye * between(-1, 0.9);
  const auto at = camera.ground(any_point(camera), height);
  if (!at) return;
  const double side = d * std::pow(10, between(-4, 2));
  const MapRect rect{at->x - side * share(), at->y - side * share(), at->x + side * share(),
                     at->y + side * share()};
  RC_ASSERT(camera.sees(rect, height - side * share(), height + side * share()));
}

TEST(Camera, SeesNoBoxBesideThePicture) {
  const Camera down = camera_at({.target = {0, 0}, .zoom = 10});  // -40 .. 40, -30 .. 30
  EXPECT_TRUE(down.sees({39, 29, 50, 50}, -1, 0));
  EXPECT_FALSE(down.sees({40.1, 0, 50, 10}, -0.1, 0));
  EXPECT_FALSE(down.sees({0, 30.1, 10, 40}, -0.1, 0));
  EXPECT_FALSE(down.sees({-50, -10, -40.1, 0}, -0.1, 0));
  EXPECT_FALSE(down.sees({-10, -50, 10, -30.1}, -0.1, 0));
  EXPECT_TRUE(down.sees({40.1, 0, 50, 10}, -10, 0)) << "its wall is seen at the edge";
  EXPECT_TRUE(down.sees({-1e6, -1e6, 1e6, 1e6}, -1, 0)) << "though no corner is seen";
  const Camera turned = camera_at({.target = {0, 0}, .zoom = 10, .yaw = kPi / 4, .tilt = 1});
  EXPECT_FALSE(turned.sees({40, -60, 50, -50}, -1, 0)) << "behind, to the right";
  EXPECT_TRUE(turned.sees({-62, 58, -58, 62}, -1, 0)) << "far ahead";
}

TEST(Camera, SeesNoBoxBeforeACornerOfThePicture) {
  const Camera camera =
      camera_at({.target = {0, 0}, .zoom = 10, .yaw = kPi / 4}, {600, 600});  // corners at 42.4
  EXPECT_FALSE(camera.sees({43, -200, 200, 200}, -0.1, 0)) << "though it is across every side";
  EXPECT_TRUE(camera.sees({42, -200, 200, 200}, -0.1, 0));
}

}  // namespace
}  // namespace earthwork::scene
