#include "client/viewer/render/offscreen.hpp"

#include <gtest/gtest.h>

#include "client/viewer/render/gl.hpp"

namespace earthwork::viewer::render {
namespace {

TEST(Offscreen, GivesRowsTopDown) {
  auto offscreen = Offscreen::make(3, 2);
  ASSERT_TRUE(offscreen) << offscreen.error().detail;
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 1, 3, 1);  // the upper row
  glClearColor(1, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glScissor(0, 0, 3, 1);
  glClearColor(0, 0, 1, 0.2F);
  glClear(GL_COLOR_BUFFER_BIT);
  const std::vector<std::uint8_t> red_then_blue = {
      255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 255, 51, 0, 0, 255, 51, 0, 0, 255, 51};
  EXPECT_EQ((*offscreen)->read(), red_then_blue);
  EXPECT_EQ((*offscreen)->read(), red_then_blue) << "reading changes nothing";
}

TEST(Offscreen, HasFourSamplesAPixelAndDepths) {
  auto offscreen = Offscreen::make(8, 8);
  ASSERT_TRUE(offscreen) << offscreen.error().detail;
  GLint samples = 0, depth_bits = 0;
  glGetIntegerv(GL_SAMPLES, &samples);
  glGetFramebufferAttachmentParameteriv(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT,
                                        GL_FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE, &depth_bits);
  EXPECT_EQ(samples, 4);
  EXPECT_GE(depth_bits, 24);
}

TEST(Offscreen, MayBeMadeAgainAfterItsEnd) {
  for (int i = 0; i < 3; ++i) {
    auto offscreen = Offscreen::make(4, 4);
    ASSERT_TRUE(offscreen) << offscreen.error().detail;
    EXPECT_EQ((*offscreen)->read().size(), 64u);
  }
}

TEST(Offscreen, RefusesASizeOutOfBounds) {
  for (const auto& [width, height] :
       {std::pair{0, 5}, {5, 0}, {-1, 5}, {kMaxOffscreenSide + 1, 5}}) {
    const auto made = Offscreen::make(width, height);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, protocol::Code::out_of_range);
    EXPECT_EQ(made.error().field, "size");
  }
}

}  // namespace
}  // namespace earthwork::viewer::render
