// earthwork-bot trace: the voxels are the picture, pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "client/bot/png_image.hpp"
#include "tests/bot/picture.hpp"
#include "tests/bot/png_file.hpp"
#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using bot::Bitmap;
using bot::picture;

/// Islands with a coast of every slope, lakes and specks in them.
Bitmap islands(int width, int height) {
  Bitmap out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double waves =
          std::sin(x * 0.11) + std::sin(y * 0.17) + std::sin((x + 2 * y) * 0.05) * 1.5;
      out.set(x, y, waves > 0.4 && (x * 7 + y * 13) % 61 != 0);
    }
  return out;
}

class Trace : public testing::Test {
 protected:
  /// Dark where the picture is set.
  std::string file_of(const Bitmap& p) {
    bot::PngFile png{.width = static_cast<unsigned>(p.width()),
                     .height = static_cast<unsigned>(p.height()),
                     .rows = {}};
    for (int y = 0; y < p.height(); ++y) {
      png.rows.emplace_back();
      for (int x = 0; x < p.width(); ++x) png.rows.back().push_back(p.at(x, y) ? 20 : 230);
    }
    bot::write_png(folder_ / "picture.png", png);
    return folder_ / "picture.png";
  }
  Outcome trace(const Bitmap& p, const std::vector<std::string>& more = {"--create"}) {
    std::vector<std::string> all{"trace", file_of(p), "--server", server_.url(), "--map", "demo"};
    all.insert(all.end(), more.begin(), more.end());
    return e2e::bot(all);
  }
  /// The states of all voxels inside the bounds, filled ones set.
  Bitmap states() {
    std::ofstream(folder_ / "states.png", std::ios::binary)
        << get(server_, "/api/maps/demo/states.png?layer=0");
    const auto read = bot::read_png(folder_ / "states.png", 128, bot::Ink::dark);
    if (!read) throw std::runtime_error(read.error().detail);
    return *read;
  }

  Folder folder_;
  ServerProgram server_;
};

/// The lower left of a larger picture is this one, and the rest is clear.
void expect_at_the_lower_left(const Bitmap& large, const Bitmap& small) {
  ASSERT_GE(large.width(), small.width());
  ASSERT_GE(large.height(), small.height());
  const int above = large.height() - small.height();
  int wrong = 0;
  for (int y = 0; y < large.height(); ++y)
    for (int x = 0; x < large.width(); ++x) {
      const bool inside = x < small.width() && y >= above;
      wrong += large.at(x, y) != (inside && small.at(x, y - above));
    }
  EXPECT_EQ(wrong, 0);
}

TEST_F(Trace, TheStatesAreThePicture) {
  const Bitmap p = islands(256, 128);
  const Outcome outcome = trace(p, {"--create", "--resolution", "64"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(states(), p);
  EXPECT_EQ(report(outcome)["pixels"], 32768);
  EXPECT_LE(report(outcome)["edits"], 30);
}

TEST_F(Trace, APictureOfAnySizeLiesAtTheLowerLeft) {
  const Bitmap p = islands(83, 45);
  EXPECT_EQ(trace(p).exit_code, 0);
  EXPECT_EQ(states().width(), 96);
  EXPECT_EQ(states().height(), 64);
  expect_at_the_lower_left(states(), p);
}

TEST_F(Trace, PaintsOverWhatWasThere) {
  EXPECT_EQ(trace(islands(64, 64)).exit_code, 0);
  Bitmap turned(64, 64);
  for (int i = 0; i < 64; ++i) turned.set(i, i, true);
  EXPECT_EQ(trace(turned).exit_code, 0);
  EXPECT_EQ(states(), turned);
}

TEST_F(Trace, InvertsAndTakesAnotherThreshold) {
  const Bitmap p = picture({"#...", "....", "....", "...."});
  EXPECT_EQ(trace(p, {"--create", "--resolution", "8", "--invert"}).exit_code, 0);
  expect_at_the_lower_left(states(), picture({".###", "####", "####", "####"}));
  EXPECT_EQ(trace(p, {"--create", "--resolution", "8", "--threshold", "231"}).exit_code, 0);
  expect_at_the_lower_left(states(), picture({"####", "####", "####", "####"}));
}

TEST_F(Trace, RefusesAMapThatIsTooSmall) {
  EXPECT_EQ(trace(islands(8, 8), {"--create", "--resolution", "8"}).exit_code, 0);
  const Outcome outcome = trace(islands(9, 8), {});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "image: its 9 x 8 pixels, from voxel (0, 0) on, reach beyond the map's bounds\n");
}

}  // namespace
}  // namespace earthwork::e2e
