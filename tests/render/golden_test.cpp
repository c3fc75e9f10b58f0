// Pictures as they are to look, kept in tests/render/golden.
#include <cmath>

#include "tests/render/stage.hpp"

namespace earthwork::viewer {
namespace {

using Golden = Stage;

constexpr double kPi = 3.14159265358979;

std::vector<protocol::MapPoint> ring(double x, double y, double radius, int points) {
  std::vector<protocol::MapPoint> ring;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / points;
    ring.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return ring;
}

/// A disc with a hole, a square and a disc that runs into it.
void paint_shapes(DrawnMap& map) {
  map.circle(-13, 1, 12.3);
  map.dig(-13, 1, 6);
  map.square(15, -2, 9.5);
  map.circle(25, 8, 6);
}

protocol::MapSettings two_layers() {
  protocol::MapSettings settings = one_layer(-1, 0);
  protocol::LayerSettings stone;
  stone.name = "stone";
  stone.color = "#8f8a80";
  stone.bottom = 0;
  stone.top = 4;
  settings.layers.push_back(stone);
  return settings;
}

void paint_castle(DrawnMap& map) {
  map.circle(0, 0, 22);
  map.dig(-12, -10, 4);
  map.square(0, 0, 9, 1);
  map.fill({0, 0, 6, voxel::Shape::square, voxel::Fill::empty}, 1);
  for (const double x : {-9.0, 9.0})
    for (const double y : {-9.0, 9.0}) map.circle(x, y, 3, 1);
}

TEST_F(Golden, ShapesFromAbove) {
  DrawnMap map(one_layer(-1, 0));
  paint_shapes(map);
  expect_golden("shapes_from_above", draw(map, {{2, 0}, 5}));
}

TEST_F(Golden, WallsSmoothAndCreased) {
  DrawnMap map(one_layer(-4, 0));
  paint_shapes(map);
  expect_golden("walls_tilted", draw(map, {{2, -1}, 5.5, 0.35, 0.85}));
}

TEST_F(Golden, WallsNear) {
  DrawnMap map(one_layer(-3, 0));
  paint_shapes(map);
  expect_golden("walls_near", draw(map, {{6, -6}, 18, -0.5, 1.05}));
}

TEST_F(Golden, DotsNear) {
  DrawnMap map(one_layer(-1, 0));
  map.circle(0, 0, 4.2);
  expect_golden("dots_near", draw(map, {{2, 1}, 26}));
}

TEST_F(Golden, DotsFadeIn) {
  DrawnMap map(one_layer(-1, 0));
  map.circle(0, 0, 9);
  expect_golden("dots_fading", draw(map, {{6, 0}, 12, 0.3, 1.0}));
}

TEST_F(Golden, TwoLayersTilted) {
  DrawnMap map(two_layers());
  paint_castle(map);
  expect_golden("two_layers", draw(map, {{0, 0}, 5.5, 0.4, 0.8}));
}

TEST_F(Golden, TwoLayersOneOfThemHidden) {
  DrawnMap map(two_layers());
  paint_castle(map);
  Picture picture = look_at(map.settings, {{0, 0}, 5.5, 0.4, 0.8}, kWidth, kHeight);
  picture.hidden.set(1);
  expect_golden("hidden_layer", draw(map, picture));
}

TEST_F(Golden, Border) {
  DrawnMap map(one_layer(-1, 0, {{-1, -1, 1, 1}}));
  map.circle(-10, 4, 14);
  map.circle(34, -8, 12);  // beyond the border
  expect_golden("border", draw(map, {{6, 0}, 3.5, 0.2, 0.5}));
}

TEST_F(Golden, OutlinesOnAnyGround) {
  DrawnMap map(one_layer(-1, 0));
  paint_shapes(map);
  Picture picture = look_at(map.settings, {{2, 0}, 5, 0, 0.4}, kWidth, kHeight);
  picture.outlines.push_back({ring(-13, 1, 9, 64), true, 0, color_of("#ffffff"), 2});
  picture.outlines.push_back({ring(5, -2, 8, 4), true, 0, color_of("#202428"), 2});
  picture.outlines.push_back({ring(22, 2, 6, 48), true, 0, color_of("#e4572e"), 2});
  picture.outlines.push_back(
      {{{-30, -14}, {-10, -16}, {-26, -10}}, false, 0, color_of("#2e86ab", 0.7F), 3});
  expect_golden("outlines", draw(map, picture));
}

}  // namespace
}  // namespace earthwork::viewer
