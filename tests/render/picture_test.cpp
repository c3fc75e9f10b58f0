#include "client/viewer/picture.hpp"

#include <gtest/gtest.h>

namespace earthwork::viewer {
namespace {

constexpr float kGrey = 128.0F / 255;

TEST(ColorOf, ReadsRedGreenAndBlue) {
  const Color color = color_of("#ff8000");
  EXPECT_FLOAT_EQ(color[0], 1);
  EXPECT_FLOAT_EQ(color[1], 128.0F / 255);
  EXPECT_FLOAT_EQ(color[2], 0);
  EXPECT_FLOAT_EQ(color[3], 1);
}

TEST(ColorOf, TakesCapitalsToo) { EXPECT_EQ(color_of("#AbCdEf"), color_of("#abcdef")); }

TEST(ColorOf, IsAsOpaqueAsItIsTold) { EXPECT_FLOAT_EQ(color_of("#000000", 0.25F)[3], 0.25F); }

TEST(ColorOf, IsGreyForAnythingElse) {
  for (const char* text : {"", "#", "8a9a5b", "#8a9a5", "#8a9a5bb", "#8a9a5g", "red", "#-10000"}) {
    EXPECT_EQ(color_of(text, 0.5F), (Color{kGrey, kGrey, kGrey, 0.5F})) << text;
  }
}

}  // namespace
}  // namespace earthwork::viewer
