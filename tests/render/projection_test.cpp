#include "client/viewer/render/projection.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/drawn_map.hpp"

namespace earthwork::viewer::render {
namespace {

/// Where a point is seen: in pixels from the upper left, from voxels and a height.
scene::ScreenPoint seen(const Projection& projection, double x, double y, float height) {
  const auto& m = projection.clip_from_voxels;
  const auto vx = static_cast<float>(x - projection.origin_x);
  const auto vy = static_cast<float>(y - projection.origin_y);
  const auto row = [&](std::size_t i) {
    return m[i] * vx + m[4 + i] * vy + m[8 + i] * height + m[12 + i];
  };
  return {(row(0) / row(3) * 0.5 + 0.5) * projection.width,
          (0.5 - row(1) / row(3) * 0.5) * projection.height};
}

TEST(Projection, HasTheScreensPixelsRounded) {
  Picture picture = look_at(one_layer(-1, 0), {{0, 0}, 10}, 101, 67);
  picture.pixel_ratio = 1.25;
  const Projection projection = projection_of(picture);
  EXPECT_EQ(projection.width, 126);  // 126.25
  EXPECT_EQ(projection.height, 84);  // 83.75
}

TEST(Projection, HasAtLeastOnePixel) {
  Picture picture = look_at(one_layer(-1, 0), {{0, 0}, 10}, 1, 1);
  picture.pixel_ratio = 0.25;
  EXPECT_EQ(projection_of(picture).width, 1);
  EXPECT_EQ(projection_of(picture).height, 1);
}

TEST(Projection, CountsFromTheVoxelNearestToTheTarget) {
  protocol::MapSettings settings = one_layer(-1, 0);
  settings.voxel_size = 2;
  const Projection projection = projection_of(look_at(settings, {{-7, 20.9}, 10}, 100, 100));
  EXPECT_EQ(std::abs(projection.origin_x + 3.5), 0.5);
  EXPECT_EQ(projection.origin_y, 10);
}

TEST(Projection, ShowsPointsWhereTheCameraSeesThem) {
  protocol::MapSettings settings = one_layer(-1, 0);
  settings.voxel_size = 0.5;
  const Picture picture = look_at(settings, {{449'999.8, -450'000.3}, 300, 0.6, 1.1}, 320, 200);
  const Projection projection = projection_of(picture);
  for (const double dx : {-0.7, 0.0, 0.4}) {
    for (const double dy : {-0.5, 0.0, 0.9}) {
      const double x = 449'999.8 + dx, y = -450'000.3 + dy;
      const auto expected = picture.camera.screen({x, y, 0.25});
      ASSERT_TRUE(expected);
      const auto shown = seen(projection, x / 0.5, y / 0.5, 0.25F);
      EXPECT_NEAR(shown.x, expected->x, 0.01) << dx << ", " << dy;
      EXPECT_NEAR(shown.y, expected->y, 0.01) << dx << ", " << dy;
    }
  }
}

}  // namespace
}  // namespace earthwork::viewer::render
