#include "client/viewer/render/renderer.hpp"

#include <algorithm>

#include "tests/render/stage.hpp"

namespace earthwork::viewer {
namespace {

using RendererTest = Stage;

const scene::Camera::Place kAbove{{0, 0}, 5};

std::array<int, 3> color_at(const Pixels& pixels, int x, int y) {
  const std::uint8_t* p = pixels.at(x, y);
  return {p[0], p[1], p[2]};
}

protocol::LayerSettings layer(const char* color, double bottom, double top) {
  protocol::LayerSettings layer;
  layer.color = color;
  layer.bottom = bottom;
  layer.top = top;
  return layer;
}

TEST_F(RendererTest, ShowsASurfaceInItsLayersOwnColour) {
  DrawnMap map(one_layer(-1, 0));
  map.square(0, 0, 10);
  EXPECT_EQ(color_at(draw(map, kAbove), kWidth / 2 + 3, kHeight / 2),
            (std::array{0x8a, 0x9a, 0x5b}));
}

TEST_F(RendererTest, TakesAnotherColourWithoutNewMeshes) {
  DrawnMap map(one_layer(-1, 0));
  map.square(0, 0, 10);
  draw(map, kAbove);
  map.settings.layers[0].color = "#c05030";
  EXPECT_EQ(color_at(draw(map, kAbove), kWidth / 2 + 3, kHeight / 2),
            (std::array{0xc0, 0x50, 0x30}));
}

TEST_F(RendererTest, LeavesEveryPixelOpaque) {
  DrawnMap map(one_layer(-1, 0, {{-1, -1, 1, 1}}));
  map.circle(0, 0, 10);
  Picture picture = look_at(map.settings, {{0, 0}, 9, 0.3, 0.8}, kWidth, kHeight);
  picture.outlines.push_back({{{0, 0}, {5, 5}, {0, 9}}, true, 0, color_of("#112233", 0.5F), 3});
  const Pixels pixels = draw(map, picture);
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) ASSERT_EQ(pixels.rgba[i], 255) << i / 4;
}

TEST_F(RendererTest, ShowsTheSameFarFromTheOriginAsNearIt) {
  constexpr double kFar = 900'000;
  DrawnMap near_map(one_layer(-3, 0)), far_map(one_layer(-3, 0));
  for (auto [map, by] : {std::pair{&near_map, 0.0}, {&far_map, kFar}}) {
    map->circle(by + 1.3, by - 0.2, 4.4);
    map->dig(by + 2, by, 1.6);
  }
  for (const double zoom : {20.0, 300.0}) {
    const Pixels near_pixels = draw(near_map, {{1.37, -2.11}, zoom, 0.4, 0.9});
    renderer_->clear();
    const Pixels far_pixels = draw(far_map, {{kFar + 1.37, kFar - 2.11}, zoom, 0.4, 0.9});
    renderer_->clear();
    EXPECT_LE(differing(near_pixels, far_pixels), 6u) << "zoom " << zoom;
    near_map.touch_all(), far_map.touch_all();
  }
}

TEST_F(RendererTest, HasNoSeamBetweenBatches) {
  // One surface across the corner of four batches, so far away that sums are rounded.
  DrawnMap map(one_layer(-1, 0));
  for (const double x : {-200.0, 0.0, 200.0}) map.square(x, 0, 110);
  const Pixels pixels = draw(map, {{37.7, 11.3}, 1.01, 0.7, 1.1});
  const auto own = color_at(pixels, kWidth / 2, kHeight / 2);
  EXPECT_EQ(own, (std::array{0x8a, 0x9a, 0x5b}));
  for (int y = kHeight / 2 - 10; y < kHeight / 2 + 10; ++y)
    for (int x = kWidth / 2 - 60; x < kWidth / 2 + 60; ++x)
      ASSERT_EQ(color_at(pixels, x, y), own) << x << ", " << y;
}

TEST_F(RendererTest, OfTwoLayersInOnePlaneShowsTheHigherNumbered) {
  protocol::MapSettings settings;
  settings.layers = {layer("#ff0000", -1, 0), layer("#0000ff", -2, 0)};
  DrawnMap map(settings);
  map.square(0, 0, 20, 0);
  map.circle(3, 1, 19, 1);
  for (const double tilt : {0.0, 0.6, 1.2}) {
    const Pixels pixels = draw(map, {{0.3, 0.2}, 6.1, 0.77, tilt});
    for (int y = 80; y < 120; ++y)
      for (int x = 120; x < 200; ++x)
        ASSERT_EQ(color_at(pixels, x, y), (std::array{0, 0, 255})) << x << ", " << y;
  }
}

TEST_F(RendererTest, OfTwoLayersShowsTheHigherOne) {
  protocol::MapSettings settings;
  settings.layers = {layer("#ff0000", -1, 0.05), layer("#0000ff", -1, 0)};
  DrawnMap map(settings);
  map.square(0, 0, 10, 0);
  map.square(0, 0, 10, 1);
  EXPECT_EQ(color_at(draw(map, kAbove), kWidth / 2, kHeight / 2), (std::array{255, 0, 0}));
}

TEST_F(RendererTest, DoesNotDrawHiddenLayers) {
  DrawnMap map(one_layer(-1, 0));
  const Pixels without = draw(map, kAbove);
  map.circle(0, 0, 10);
  Picture picture = look_at(map.settings, kAbove, kWidth, kHeight);
  picture.hidden.set(0);
  EXPECT_EQ(draw(map, picture).rgba, without.rgba);
  EXPECT_EQ(counts_.triangles, 0u);
}

TEST_F(RendererTest, DarkensGroundOnceWhereShadowsMeet) {
  protocol::MapSettings settings;
  settings.layers = {layer("#ff0000", -1, 5), layer("#0000ff", -1, 5.5)};
  DrawnMap map(settings);
  const int x = kWidth / 2 + 36, y = kHeight / 2 + 12;  // right of the squares, on the ground
  const auto bright = color_at(draw(map, kAbove), x, y);
  map.square(0, 0, 5, 0);
  const auto dark = color_at(draw(map, kAbove), x, y);
  EXPECT_LT(dark[0], bright[0] - 20);
  map.square(0, 0, 5, 1);
  EXPECT_EQ(color_at(draw(map, kAbove), x, y), dark);
}

TEST_F(RendererTest, FollowsTheScene) {
  DrawnMap map(one_layer(-1, 0));
  const Pixels nothing = draw(map, kAbove);
  map.circle(0, 0, 10);
  const Pixels disc = draw(map, kAbove);
  EXPECT_NE(disc.rgba, nothing.rgba);
  map.dig(0, 0, 12);
  EXPECT_EQ(draw(map, kAbove).rgba, nothing.rgba);
  map.circle(0, 0, 10);
  EXPECT_EQ(draw(map, kAbove).rgba, disc.rgba);
}

TEST_F(RendererTest, ClearForgetsAllMeshes) {
  DrawnMap map(one_layer(-1, 0));
  const Pixels nothing = draw(map, kAbove);
  map.circle(0, 0, 10);
  draw(map, kAbove);
  renderer_->clear();
  EXPECT_EQ(draw(map, kAbove).rgba, nothing.rgba);
}

TEST_F(RendererTest, TakesAMapWithOtherChunks) {
  DrawnMap map(one_layer(-1, 0));
  map.square(100, 0, 20);
  draw(map, kAbove);
  protocol::MapSettings small = one_layer(-1, 0);
  small.chunk_resolution = 8;
  DrawnMap other(small), reference(small);
  other.circle(1, 1, 9);
  const Pixels pixels = draw(other, kAbove);
  renderer_->clear();
  reference.circle(1, 1, 9);
  EXPECT_EQ(pixels.rgba, draw(reference, kAbove).rgba);
}

TEST_F(RendererTest, ScalesWithTheVoxels) {
  DrawnMap map(one_layer(-2, 0, {{-1, -1, 1, 1}}));
  map.circle(3, 2, 9);
  protocol::MapSettings large = one_layer(-8, 0, {{-1, -1, 1, 1}});
  large.voxel_size = 4;
  DrawnMap scaled(large);
  scaled.circle(12, 8, 36);
  const Pixels pixels = draw(map, {{1, 0}, 12, 0.3, 0.7});
  renderer_->clear();
  EXPECT_LE(differing(pixels, draw(scaled, {{4, 0}, 3, 0.3, 0.7})), 6u);
}

TEST_F(RendererTest, CountsTheTrianglesInView) {
  DrawnMap map(one_layer(-1, 0));
  map.square(0, 0, 5);
  map.square(100'000, 0, 5);
  draw(map, kAbove);
  std::size_t all = 0;
  for (const auto& [key, chunk] : map.scene().chunks())
    all += chunk.mesh.triangles.size() / 3 + 2 * chunk.mesh.sections.size();
  EXPECT_EQ(counts_.triangles * 2, all);
  draw(map, {{5'000, 0}, 5});
  EXPECT_EQ(counts_.triangles, 0u);
}

TEST_F(RendererTest, DrawsManyFullChunksInFewCalls) {
  DrawnMap map(one_layer(-1, 0, {{0, 0, 64, 64}}));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) map.square(256 * x + 128, 256 * y + 128, 130);
  draw(map, {{1024, 1024}, 0.09});
  EXPECT_EQ(map.scene().chunks().size(), 4096u);
  EXPECT_EQ(counts_.triangles, 2 * 4096u);
  EXPECT_EQ(counts_.draws, 64u + 2);  // the batches, the ground and the border
}

TEST_F(RendererTest, LeavesDotsOutsideOfTheMap) {
  DrawnMap map(one_layer(-1, 0, {{0, 0, 1, 1}}));
  const Pixels pixels = draw(map, {{0, 16}, 30});
  const auto outside = color_at(pixels, 2, 2);
  int inside = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool dark = color_at(pixels, x, y)[0] < 160;
      if (x < kWidth / 2 - 6) ASSERT_EQ(color_at(pixels, x, y), outside) << x << ", " << y;
      if (x > kWidth / 2 + 6) inside += dark ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 25);
}

TEST_F(RendererTest, PutsADotOnTheMiddleOfAVoxel) {
  DrawnMap map(one_layer(-1, 0));
  const Pixels pixels = draw(map, {{0.5, 0.5}, 40});
  EXPECT_LT(color_at(pixels, kWidth / 2, kHeight / 2)[0], 140);
  EXPECT_LT(color_at(pixels, kWidth / 2 + 40, kHeight / 2 - 40)[0], 140);
  EXPECT_GT(color_at(pixels, kWidth / 2 + 20, kHeight / 2 - 20)[0], 220);
}

TEST_F(RendererTest, IsAsFineAsItsPixels) {
  // Half as many CSS pixels, each of two: the same picture but for lines and dots.
  DrawnMap map(one_layer(-8, 0));
  map.circle(0, 0, 15);
  const Pixels coarse = draw(map, {{0, 0}, 5, 0.2, 0.6});
  Picture picture = look_at(map.settings, {{0, 0}, 2.5, 0.2, 0.6}, kWidth / 2.0, kHeight / 2.0);
  picture.pixel_ratio = 2;
  EXPECT_LE(differing(coarse, draw(map, picture)), 6u);
}

TEST_F(RendererTest, EndsQuietlyWhenItsContextIsGone) {
  DrawnMap map(one_layer(-1, 0));
  map.circle(0, 0, 10);
  draw(map, kAbove);
  offscreen_->release();
  renderer_.reset();
  offscreen_.reset();
}

}  // namespace
}  // namespace earthwork::viewer
