// Plans: painted on voxels, they give the picture back, with few edits within the limits.
#include "client/bot/trace_plan.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "protocol/limits.hpp"
#include "tests/bot/picture.hpp"

namespace earthwork::bot {
namespace {

using protocol::Edit;
using protocol::MapSettings;

/// Stamps squares on a plain grid as GEOMETRY says: a voxel is covered when its centre is no
/// further from the stamp's than the radius, either way. A voxel beyond the picture is a failure.
class PlainGround {
 public:
  PlainGround(int width, int height, double voxel_size, bool filled)
      : states_(width, height), voxel_size_(voxel_size) {
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = filled;
  }

  void apply(const Edit& edit) {
    for (const auto& centre : edit.path) stamp(centre.x, centre.y, edit.radius, edit.fill);
  }
  /// As a picture, its top row the uppermost row of voxels.
  const Bitmap& states() const { return states_; }
  bool reached_beyond() const { return reached_beyond_; }

 private:
  double centre_of(int i) const { return (i + 0.5) * voxel_size_; }

  void stamp(double x, double y, double radius, bool fill) {
    const int i0 = static_cast<int>(std::floor((x - radius) / voxel_size_)) - 1;
    const int j0 = static_cast<int>(std::floor((y - radius) / voxel_size_)) - 1;
    const int side = static_cast<int>(2 * radius / voxel_size_) + 4;
    for (int j = j0; j < j0 + side; ++j)
      for (int i = i0; i < i0 + side; ++i) {
        if (std::abs(centre_of(i) - x) > radius || std::abs(centre_of(j) - y) > radius) continue;
        if (i < 0 || j < 0 || i >= states_.width() || j >= states_.height())
          reached_beyond_ = true;
        else
          states_.set(i, states_.height() - 1 - j, fill);
      }
  }

  Bitmap states_;
  double voxel_size_;
  bool reached_beyond_ = false;
};

std::size_t stamps(const std::vector<Edit>& plan) {
  std::size_t count = 0;
  for (const Edit& edit : plan) count += edit.path.size();
  return count;
}

/// A disc of this radius in a picture just large enough.
Bitmap disc(int radius) {
  Bitmap out(2 * radius, 2 * radius);
  for (int y = 0; y < 2 * radius; ++y)
    for (int x = 0; x < 2 * radius; ++x)
      out.set(x, y, std::hypot(x + 0.5 - radius, y + 0.5 - radius) <= radius);
  return out;
}

TEST(TracePlan, StampsASquareSoThatItsOutlineLiesHalfWayBetweenVoxels) {
  const auto plan = plan_trace(picture({"....", "###.", "###.", "###."}), Ground::empty, {});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_EQ(plan[0].stencil, protocol::StencilShape::square);
  EXPECT_TRUE(plan[0].fill);
  EXPECT_TRUE(plan[0].is_path);
  EXPECT_EQ(plan[0].radius, 1.5);
  EXPECT_EQ(plan[0].path, (std::vector<protocol::MapPoint>{{1.5, 1.5}}));
}

TEST(TracePlan, PutsTheTopRowOfThePictureOnTop) {
  const auto plan = plan_trace(picture({"#..", "...", "...", "..."}), Ground::empty, {});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_EQ(plan[0].path, (std::vector<protocol::MapPoint>{{0.5, 3.5}}));
}

TEST(TracePlan, PutsEqualSquaresIntoOneEdit) {
  const auto plan = plan_trace(picture({"#.#.#", ".....", "#.#.#"}), Ground::empty, {});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_EQ(plan[0].path.size(), 6u);
}

TEST(TracePlan, FillsOverASmallHoleAndEmptiesIt) {
  const auto plan =
      plan_trace(picture({"#####", "#####", "##.##", "#####", "#####"}), Ground::empty, {});
  ASSERT_EQ(plan.size(), 2u);
  EXPECT_TRUE(plan[0].fill);
  EXPECT_EQ(stamps({plan[0]}), 4u);  // of 4 x 4
  EXPECT_FALSE(plan[1].fill);
  EXPECT_EQ(plan[1].path, (std::vector<protocol::MapPoint>{{2.5, 2.5}}));
}

TEST(TracePlan, LeavesAHoleOfNinePixelsOut) {
  Bitmap p = disc(20);
  for (int y = 19; y < 22; ++y)
    for (int x = 19; x < 22; ++x) p.set(x, y, false);
  for (const Edit& edit : plan_trace(p, Ground::empty, {})) EXPECT_TRUE(edit.fill);
}

TEST(TracePlan, IsEmptyForAClearPictureOnEmptyGround) {
  EXPECT_TRUE(plan_trace(Bitmap(300, 200), Ground::empty, {}).empty());
}

TEST(TracePlan, EmptiesUnknownGroundFirst) {
  const auto plan = plan_trace(Bitmap(300, 200), Ground::unknown, {});
  ASSERT_EQ(plan.size(), 1u);
  EXPECT_FALSE(plan[0].fill);
  EXPECT_EQ(plan[0].radius, 96);
  EXPECT_EQ(plan[0].path.size(), 4u);
}

TEST(TracePlan, PaintsADiscOfAMillionPixelsWithFewEdits) {
  const Bitmap p = disc(560);
  const auto plan = plan_trace(p, Ground::empty, {});
  EXPECT_LE(plan.size(), 30u);
  EXPECT_LE(stamps(plan), 2000u);
  PlainGround ground(p.width(), p.height(), 1, false);
  for (const Edit& edit : plan) ground.apply(edit);
  EXPECT_EQ(ground.states(), p);
}

TEST(TracePlan, KeepsToTheLimitsOfAnEditOnSmallChunks) {
  MapSettings settings;
  settings.chunk_resolution = 8;
  const Bitmap p = disc(600);
  const auto plan = plan_trace(p, Ground::unknown, settings);
  for (const Edit& edit : plan) {
    const auto checked = protocol::check_edit(edit, settings);
    EXPECT_TRUE(checked) << checked.error().detail;
    EXPECT_LE(edit.path.size(), protocol::kMaxPathPoints);
  }
}

TEST(TracePlan, SplitsAPathAtTheLimitOfPoints) {
  Bitmap p(2 * 1025, 1);
  for (int x = 0; x < p.width(); x += 2) p.set(x, 0, true);
  const auto plan = plan_trace(p, Ground::empty, {});
  ASSERT_EQ(plan.size(), 2u);
  EXPECT_EQ(plan[0].path.size(), 1024u);
  EXPECT_EQ(plan[1].path.size(), 1u);
}

RC_GTEST_PROP(TracePlan, GivesThePictureBack, ()) {
  const Bitmap p = *any_picture();
  MapSettings settings;
  settings.chunk_resolution = *rc::gen::element(8, 16, 32, 64);
  settings.voxel_size = *rc::gen::element(1.0, 0.25, 0.3, 1e-6, 700.0);
  const bool dirty = *rc::gen::arbitrary<bool>();

  const auto plan = plan_trace(p, dirty ? Ground::unknown : Ground::empty, settings);
  PlainGround ground(p.width(), p.height(), settings.voxel_size, dirty);
  for (const Edit& edit : plan) {
    RC_ASSERT(bool(protocol::check_edit(edit, settings)));
    ground.apply(edit);
  }
  RC_ASSERT(ground.states() == p);
  RC_ASSERT(!ground.reached_beyond());
}

RC_GTEST_PROP(TracePlan, NeedsNoMoreStampsThanPixels, ()) {
  const Bitmap p = *any_picture();
  std::size_t set = 0;
  for (std::size_t i = 0; i < p.size(); ++i) set += p[i];
  RC_ASSERT(stamps(plan_trace(p, Ground::empty, {})) <= 3 * set);
}

}  // namespace
}  // namespace earthwork::bot
