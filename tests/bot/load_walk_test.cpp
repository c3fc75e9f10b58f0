// The walks of a load run: the same for the same seed, inside their square, and busy.
#include "client/bot/load_walk.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace earthwork::bot {
namespace {

constexpr PaintedSquare kSquare{.x0 = -64, .y0 = 32, .side = 128};

TEST(BrushWalk, IsTheSameForTheSameSeedAndAnotherForAnother) {
  BrushWalk one(kSquare, 3, 7), same(kSquare, 3, 7), other(kSquare, 3, 8);
  int equal = 0;
  for (int i = 0; i < 1000; ++i) {
    const protocol::Edit edit = one.next();
    EXPECT_EQ(same.next(), edit);
    equal += other.next().path == edit.path ? 1 : 0;
  }
  EXPECT_LT(equal, 5);
}

// Whatever library it is built with: a run can be told by its seed.
TEST(BrushWalk, StartsWhereItAlwaysDid) {
  BrushWalk walk({.x0 = 0, .y0 = 0, .side = 256}, 3, 1);
  const protocol::Edit first = walk.next();
  const protocol::Edit second = walk.next();
  EXPECT_EQ(first.path[0], (protocol::MapPoint{.x = 5.375, .y = 89.828125}));
  EXPECT_EQ(second.path[0], (protocol::MapPoint{.x = 2.515625, .y = 89.28125}));
}

RC_GTEST_PROP(BrushWalk, StaysInItsSquare, ()) {
  const double radius = *rc::gen::inRange(1, 400) / 8.0;
  BrushWalk walk(kSquare, radius, *rc::gen::arbitrary<std::uint64_t>());
  for (int i = 0; i < 500; ++i) {
    const protocol::Edit edit = walk.next();
    RC_ASSERT(edit.radius == radius);
    RC_ASSERT(edit.path.size() == 1u);
    RC_ASSERT(edit.path[0].x >= -64 && edit.path[0].x <= 64);
    RC_ASSERT(edit.path[0].y >= 32 && edit.path[0].y <= 160);
  }
}

TEST(BrushWalk, PaintsStrokesThatFillAndStrokesThatEmptyAllOver) {
  BrushWalk walk(kSquare, 3, 5);
  std::map<std::int64_t, std::set<bool>> fills;
  std::set<std::pair<int, int>> quarters;
  int filling = 0;
  for (int i = 0; i < 10'000; ++i) {
    const protocol::Edit edit = walk.next();
    fills[edit.stroke.value()].insert(edit.fill);
    filling += edit.fill ? 1 : 0;
    quarters.emplace(edit.path[0].x < 0, edit.path[0].y < 96);
  }
  EXPECT_EQ(fills.begin()->first, 1);
  EXPECT_GE(fills.size(), 10'000u / 32);
  EXPECT_LE(fills.size(), 10'000u / 8 + 1);
  for (const auto& [stroke, both] : fills) EXPECT_EQ(both.size(), 1u) << stroke;
  EXPECT_GT(filling, 4000);
  EXPECT_LT(filling, 6000);
  EXPECT_EQ(quarters.size(), 4u);
}

TEST(BrushWalk, MovesAboutARadiusAStep) {
  BrushWalk walk({.x0 = -1e5, .y0 = -1e5, .side = 2e5}, 4, 3);
  protocol::Edit before = walk.next();
  for (int i = 0; i < 1000; ++i) {
    const protocol::Edit edit = walk.next();
    const double moved =
        std::hypot(edit.path[0].x - before.path[0].x, edit.path[0].y - before.path[0].y);
    if (edit.stroke == before.stroke) {
      EXPECT_GE(moved, 1.95);
      EXPECT_LE(moved, 6.05);
    }
    before = edit;
  }
}

TEST(PaintedSquare, BeginsAtTheMapsCornerAndEndsWithinItsBounds) {
  protocol::MapSettings settings;
  EXPECT_EQ(painted_square(settings, 256), (PaintedSquare{.x0 = 0, .y0 = 0, .side = 256}));
  settings.chunk_resolution = 16;
  settings.voxel_size = 0.5;
  settings.chunks = {-2, 3, 6, 5};  // 64 x 16 map units
  EXPECT_EQ(painted_square(settings, 256), (PaintedSquare{.x0 = -16, .y0 = 24, .side = 16}));
  EXPECT_EQ(painted_square(settings, 10), (PaintedSquare{.x0 = -16, .y0 = 24, .side = 10}));
}

}  // namespace
}  // namespace earthwork::bot
