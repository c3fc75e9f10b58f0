// The map that a new server shows.
#include "server/app/demo.hpp"

#include <gtest/gtest.h>

#include "server/history/fold.hpp"
#include "server/mesh/figures.hpp"
#include "server/room/manual_context.hpp"
#include "tests/room/atlas_calls.hpp"
#include "tests/room/kept_shelf.hpp"

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

TEST(Demo, IsPaintedOnce) {
  room::ManualContext context;
  room::Atlas atlas({.make_strand = [&context] { return context.make_strand(); }});
  int done = 0;
  for (int i = 1; i <= 2; ++i) {
    add_demo(atlas, [&](const protocol::Result<void>& result) {
      EXPECT_TRUE(result);
      ++done;
    });
    context.run();
    EXPECT_EQ(done, i);
    EXPECT_EQ(room::find_map(atlas, "demo")->info().seq, demo_edits().size());
  }
  EXPECT_EQ(room::find_map(atlas, "demo")->info().users, 0u);
}

TEST(Demo, IsStoredWhenItIsDone) {
  room::ManualContext context;
  const auto shelf = std::make_shared<room::KeptShelf>();
  room::Atlas atlas({.make_strand = [&context] { return context.make_strand(); }, .shelf = shelf});
  shelf->hold();
  bool done = false;
  add_demo(atlas, [&](const protocol::Result<void>&) { done = true; });
  context.run();
  EXPECT_FALSE(done);
  shelf->go_on();
  context.run();
  EXPECT_TRUE(done);
  EXPECT_EQ(shelf->maps.at("demo").journal->last_seq(), demo_edits().size());
}

TEST(Demo, SaysWhenItCouldNotBeStored) {
  room::ManualContext context;
  const auto shelf = std::make_shared<room::KeptShelf>();
  room::Atlas atlas({.make_strand = [&context] { return context.make_strand(); }, .shelf = shelf});
  shelf->hold();
  std::optional<protocol::Result<void>> told;
  add_demo(atlas, [&](const protocol::Result<void>& result) { told = result; });
  context.run();
  shelf->maps.at("demo").unwritable = {protocol::Code::disk_full, "no room", {}};
  shelf->go_on();
  context.run();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->error().code, protocol::Code::storage_failed);
}

}  // namespace
}  // namespace earthwork::app
