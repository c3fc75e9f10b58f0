// Voxel states as pixels.
#include "server/room/states_picture.hpp"

#include <gtest/gtest.h>

#include "server/history/fold.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

bool black(const StatesPicture& picture, std::size_t x, std::size_t y) {
  return (picture.bits[y * picture.row_bytes() + x / 8] >> (7 - x % 8) & 1) == 0;
}

voxel::Map bounded(std::array<std::int32_t, 4> chunks) {
  return history::make_map({.chunk_resolution = 8, .chunks = chunks});
}

TEST(StatesPicture, ShowsEveryVoxelOfTheBounds) {
  voxel::Map map = bounded({-1, 0, 2, 2});
  history::apply(map, disc(3, 5, 2.5));
  history::apply(map, box(-4.5, 12.5, 1));
  history::apply(map, box(15.5, 15.5, 0));
  const auto picture = draw_states(map, 0).value();
  ASSERT_EQ(picture.width, 24u);
  ASSERT_EQ(picture.height, 16u);
  int filled = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 24; ++x) {
      const bool is = black(picture, static_cast<std::size_t>(x), static_cast<std::size_t>(15 - y));
      EXPECT_EQ(is, map.filled(0, x - 8, y)) << x << " " << y;
      filled += is;
    }
  EXPECT_EQ(static_cast<std::uint64_t>(filled), map.filled_voxels());
  EXPECT_TRUE(black(picture, 23, 0));  // the top right
}

TEST(StatesPicture, OfAMapWithoutBoundsShowsWhatIsThere) {
  voxel::Map map = history::make_map({.chunk_resolution = 8, .chunks = {}});
  history::apply(map, box(20.5, -3.5, 0));
  const auto picture = draw_states(map, 0).value();
  EXPECT_EQ(picture.width, 8u);
  EXPECT_EQ(picture.height, 8u);
  EXPECT_TRUE(black(picture, 4, 3));
}

TEST(StatesPicture, ShowsTheLayerThatIsAskedFor) {
  protocol::MapSettings settings{.chunk_resolution = 8, .chunks = {{0, 0, 1, 1}}};
  settings.layers.resize(2);
  voxel::Map map = history::make_map(settings);
  auto edit = box(0.5, 0.5, 0);
  edit.layer = 1;
  history::apply(map, edit);
  EXPECT_TRUE(black(draw_states(map, 1).value(), 0, 7));
  EXPECT_FALSE(black(draw_states(map, 0).value(), 0, 7));
  EXPECT_EQ(draw_states(map, 2).error().code, Code::out_of_range);
}

TEST(StatesPicture, OfNothingWithoutBoundsIsRefused) {
  EXPECT_EQ(draw_states(history::make_map({}), 0).error().code, Code::bad_state);
}

TEST(StatesPicture, HasALimit) {
  // 16,384 x 16,384 pixels, and 64 more columns.
  const auto map = [](std::int32_t width) {
    return history::make_map({.chunk_resolution = 64, .chunks = {{0, 0, width, 256}}});
  };
  EXPECT_TRUE(draw_states(map(256), 0));
  const auto refused = draw_states(map(257), 0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_large);
  EXPECT_NE(refused.error().detail.find("268435456"), std::string::npos);
}

}  // namespace
}  // namespace earthwork::room
