// The map that a new server shows.
#include "server/app/demo.hpp"

#include <gtest/gtest.h>

#include "server/history/fold.hpp"
#include "server/mesh/figures.hpp"
#include "server/room/manual_context.hpp"

namespace earthwork::app {
namespace {

TEST(Demo, KeepsToEveryLimit) {
  const auto settings = demo_settings();
  for (const auto& edit : demo_edits()) {
    const auto checked = protocol::check_edit(edit, settings);
    EXPECT_TRUE(checked) << checked.error().detail;
  }
}

TEST(Demo, FillsAndEmptiesWithCirclesAndSquares) {
  int circles = 0, squares = 0, emptied = 0, paths = 0;
  for (const auto& edit : demo_edits()) {
    (edit.stencil == protocol::StencilShape::circle ? circles : squares) += 1;
    emptied += !edit.fill;
    paths += edit.is_path;
  }
  EXPECT_GE(circles, 5);
  EXPECT_GE(squares, 3);
  EXPECT_GE(emptied, 5);
  EXPECT_GE(paths, 1);
}

TEST(Demo, ShowsSharpCornersOnBothLayers) {
  voxel::Map map = history::make_map(demo_settings());
  for (const auto& edit : demo_edits()) history::apply(map, edit);
  const auto figures = mesh::count_figures(map, demo_settings().max_feature_angle);
  EXPECT_GT(figures.sharp_features, 40u);
  EXPECT_GT(figures.surface_area, 5000);
  EXPECT_TRUE(map.filled(0, -20, 0));
  EXPECT_TRUE(map.filled(1, -4, 12));
  EXPECT_FALSE(map.filled(1, 2, 18));  // the bite
}

TEST(Demo, IsPaintedBeforeAnybodyCanSeeIt) {
  room::ManualContext context;
  room::Atlas atlas([&context] { return context.make_strand(); });
  ASSERT_TRUE(add_demo(atlas));
  const auto room = atlas.find("demo");
  ASSERT_TRUE(room);
  std::size_t seen = 0;
  room->strand().post([&] { room->strand().post([&] { seen = room->info().seq; }); });
  context.run();
  EXPECT_EQ(seen, demo_edits().size());
  EXPECT_EQ(room->info().users, 0u);
  EXPECT_FALSE(add_demo(atlas));
}

}  // namespace
}  // namespace earthwork::app
