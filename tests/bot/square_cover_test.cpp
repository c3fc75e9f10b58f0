// Covers: all that is wanted, nothing that is not allowed, large squares first.
#include "client/bot/square_cover.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/bot/picture.hpp"

namespace earthwork::bot {
namespace {

constexpr int kSides[] = {8, 4, 3, 2, 1};

Bitmap painted(const std::vector<PixelSquare>& squares, const Bitmap& like) {
  Bitmap out(like.width(), like.height());
  for (const PixelSquare& s : squares)
    for (int y = s.y; y < s.y + s.side; ++y)
      for (int x = s.x; x < s.x + s.side; ++x) out.set(x, y, true);
  return out;
}

TEST(SquareCover, TakesOneSquareForASquare) {
  const Bitmap p = picture({"....", ".###", ".###", ".###"});
  EXPECT_EQ(cover_with_squares(p, p, kSides),
            (std::vector<PixelSquare>{{.x = 1, .y = 1, .side = 3}}));
}

TEST(SquareCover, LetsSquaresOverlapRatherThanFillWithSmallOnes) {
  const Bitmap p = picture({"#####", "#####", "#####", "#####"});
  EXPECT_EQ(cover_with_squares(p, p, kSides),
            (std::vector<PixelSquare>{{.x = 0, .y = 0, .side = 4}, {.x = 1, .y = 0, .side = 4}}));
}

TEST(SquareCover, GoesOverWhatIsAllowedAndNotWanted) {
  const Bitmap wanted = picture({"#.#", "...", "#.#"});
  const Bitmap allowed = picture({"###", "###", "###"});
  EXPECT_EQ(cover_with_squares(wanted, allowed, kSides),
            (std::vector<PixelSquare>{{.x = 0, .y = 0, .side = 3}}));
}

TEST(SquareCover, IsEmptyForAClearPicture) {
  EXPECT_TRUE(cover_with_squares(Bitmap(7, 3), Bitmap(7, 3), kSides).empty());
}

TEST(SquareCover, UsesASideAsLongAsThePicture) {
  Bitmap p(64, 64);
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = 1;
  constexpr int sides[] = {64, 1};
  EXPECT_EQ(cover_with_squares(p, p, sides).size(), 1u);
}

RC_GTEST_PROP(SquareCover, HoldsWhatIsWantedAndNothingThatIsNotAllowed, ()) {
  const Bitmap allowed = *any_picture();
  Bitmap wanted = allowed;
  const int every = *rc::gen::inRange(1, 5);
  for (std::size_t i = 0; i < wanted.size(); i += static_cast<std::size_t>(every)) wanted[i] = 0;

  const auto squares = cover_with_squares(wanted, allowed, kSides);
  const Bitmap covered = painted(squares, allowed);
  for (std::size_t i = 0; i < covered.size(); ++i) {
    RC_ASSERT(covered[i] >= wanted[i]);
    RC_ASSERT(covered[i] <= allowed[i]);
  }
  RC_ASSERT(std::is_sorted(squares.begin(), squares.end(),
                           [](const auto& a, const auto& b) { return a.side > b.side; }));
}

RC_GTEST_PROP(SquareCover, NeedsNoMoreSquaresThanPixels, ()) {
  const Bitmap p = *any_picture();
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < p.size(); ++i) pixels += p[i];
  RC_ASSERT(cover_with_squares(p, p, kSides).size() <= pixels);
}

}  // namespace
}  // namespace earthwork::bot
