// PNG files: libpng reads back what was drawn.
#include "server/net/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <vector>

namespace earthwork::net {
namespace {

/// Grey values, row by row from the top.
std::vector<std::uint8_t> read_grey(const std::string& file, std::uint32_t& width,
                                    std::uint32_t& height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&image, file.data(), file.size())) return {};
  image.format = PNG_FORMAT_GRAY;
  width = image.width, height = image.height;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr);
  return pixels;
}

TEST(Png, ReadsBackAsItWasDrawn) {
  const room::StatesPicture picture{16, 3, {0xFF, 0x7F, 0x0F, 0xFF, 0xAA, 0x00}};
  const auto file = encode_png(picture);
  ASSERT_TRUE(file);
  std::uint32_t width = 0, height = 0;
  const auto grey = read_grey(*file, width, height);
  ASSERT_EQ(width, 16u);
  ASSERT_EQ(height, 3u);
  for (std::size_t y = 0; y < 3; ++y)
    for (std::size_t x = 0; x < 16; ++x) {
      const bool white = picture.bits[y * 2 + x / 8] >> (7 - x % 8) & 1;
      EXPECT_EQ(grey[y * 16 + x], white ? 255 : 0) << x << " " << y;
    }
}

TEST(Png, MayBeWiderThanAMillion) {
  room::StatesPicture picture{2'000'008, 1, std::vector<std::uint8_t>(250'001, 0xFF)};
  picture.bits.back() = 0xFE;
  const auto file = encode_png(picture);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_LT(file->size(), 10'000u);
}

TEST(Png, ThatCannotBeIsAFailure) {
  const auto file = encode_png({0, 0, {}});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, protocol::Code::internal);
}

}  // namespace
}  // namespace earthwork::net
