// Pictures from files: every kind of PNG becomes two colours, what is no picture becomes an error.
#include "client/bot/png_image.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/bot/picture.hpp"
#include "tests/bot/png_file.hpp"

namespace earthwork::bot {
namespace {

class PngImage : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("png_image_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path() const { return (folder_ / "picture.png").string(); }

  Bitmap read(const PngFile& png, int threshold = 128, Ink ink = Ink::dark) {
    write_png(path(), png);
    const auto result = read_png(path(), threshold, ink);
    if (!result) ADD_FAILURE() << result.error().detail;
    return result ? *result : Bitmap(1, 1);
  }
  /// The bytes 0, 1, 2 ... of a PNG are changed before it is read.
  std::string error_of(std::streamoff at, const std::string& bytes) {
    write_png(path(), {.width = 2, .height = 1, .rows = {{0, 255}}});
    std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file << bytes;
    file.close();
    const auto result = read_png(path(), 128, Ink::dark);
    return result ? "" : result.error().detail;
  }

  std::filesystem::path folder_;
};

TEST_F(PngImage, SetsWhatIsDarkerThanTheThreshold) {
  const PngFile grey{.width = 4, .height = 1, .rows = {{0, 127, 128, 255}}};
  EXPECT_EQ(read(grey), picture({"##.."}));
  EXPECT_EQ(read(grey, 1), picture({"#..."}));
  EXPECT_EQ(read(grey, 0), picture({"...."}));
  EXPECT_EQ(read(grey, 256), picture({"####"}));
}

TEST_F(PngImage, SetsWhatIsLightWhenAsked) {
  const PngFile grey{.width = 4, .height = 1, .rows = {{0, 127, 128, 255}}};
  EXPECT_EQ(read(grey, 128, Ink::light), picture({"..##"}));
}

TEST_F(PngImage, KeepsRowsAndColumnsInTheirOrder) {
  EXPECT_EQ(read({.width = 3, .height = 2, .rows = {{0, 255, 255}, {255, 0, 255}}}),
            picture({"#..", ".#."}));
}

TEST_F(PngImage, WeighsColoursAsPeopleSeeThem) {
  const PngFile colours{.width = 4,
                        .height = 1,
                        .colour_type = PNG_COLOR_TYPE_RGB,
                        .rows = {{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0}}};
  EXPECT_EQ(read(colours), picture({"#.#."}));  // 76, 150, 29, 226
  EXPECT_EQ(read(colours, 76), picture({"..#."}));
  EXPECT_EQ(read(colours, 77), picture({"#.#."}));
}

TEST_F(PngImage, LaysWhatIsTransparentOverWhite) {
  const PngFile grey{.width = 4,
                     .height = 1,
                     .colour_type = PNG_COLOR_TYPE_GRAY_ALPHA,
                     .rows = {{0, 255, 0, 0, 0, 128, 0, 127}}};  // black, more and less opaque
  EXPECT_EQ(read(grey), picture({"#.#."}));
  const PngFile colour{.width = 2,
                       .height = 1,
                       .colour_type = PNG_COLOR_TYPE_RGB_ALPHA,
                       .rows = {{0, 0, 0, 128, 0, 0, 0, 127}}};
  EXPECT_EQ(read(colour), picture({"#."}));
}

TEST_F(PngImage, ReadsOneBitAndSixteenBitPixels) {
  EXPECT_EQ(read({.width = 4, .height = 1, .depth = 1, .rows = {{0b0101'0000}}}),
            picture({"#.#."}));
  EXPECT_EQ(
      read({.width = 3, .height = 1, .depth = 16, .rows = {{0x7f, 0x00, 0x81, 0x00, 0xff, 0xff}}}),
      picture({"#.."}));
}

TEST_F(PngImage, ReadsAPalette) {
  EXPECT_EQ(read({.width = 4,
                  .height = 1,
                  .colour_type = PNG_COLOR_TYPE_PALETTE,
                  .depth = 8,
                  .palette = {{255, 255, 255}, {10, 20, 30}},
                  .rows = {{0, 1, 1, 0}}}),
            picture({".##."}));
}

TEST_F(PngImage, ReadsInterlacedFiles) {
  PngFile png{.width = 9, .height = 9, .interlaced = true, .rows = {}};
  Bitmap expected(9, 9);
  for (int y = 0; y < 9; ++y) {
    png.rows.emplace_back(9, std::uint8_t{255});
    for (int x = y; x < 9; x += 2) {
      png.rows.back()[static_cast<std::size_t>(x)] = 0;
      expected.set(x, y, true);
    }
  }
  EXPECT_EQ(read(png), expected);
}

TEST_F(PngImage, ReadsInterlacedFilesOfSixteenBits) {
  PngFile png{.width = 16, .height = 16, .depth = 16, .interlaced = true, .rows = {}};
  png.rows.assign(16, std::vector<std::uint8_t>(32, 255));
  png.rows[3][6] = png.rows[3][7] = 0;
  Bitmap expected(16, 16);
  expected.set(3, 3, true);
  EXPECT_EQ(read(png), expected);
}

TEST_F(PngImage, TakesTheUpperHalfOfSixteenBits) {
  EXPECT_EQ(
      read({.width = 3, .height = 1, .depth = 16, .rows = {{0x7f, 0xff, 0x80, 0x00, 0x80, 0xff}}}),
      picture({"#.."}));
}

TEST_F(PngImage, TakesSamplesAsTheyStandWhateverTheGamma) {
  for (const double gamma : {1.0, 0.45455, 0.2}) {
    EXPECT_EQ(read({.width = 4, .height = 1, .gamma = gamma, .rows = {{60, 127, 128, 190}}}),
              picture({"##.."}));
    EXPECT_EQ(read({.width = 2,
                    .height = 1,
                    .depth = 16,
                    .gamma = gamma,
                    .rows = {{0x7f, 0xff, 0x80, 0x00}}}),
              picture({"#."}));
    EXPECT_EQ(read({.width = 2,
                    .height = 1,
                    .colour_type = PNG_COLOR_TYPE_RGB_ALPHA,
                    .gamma = gamma,
                    .rows = {{127, 127, 127, 255, 128, 128, 128, 255}}}),
              picture({"#."}));
  }
}

TEST_F(PngImage, NamesAFileThatIsNotThere) {
  const auto result = read_png((folder_ / "nothing.png").string(), 128, Ink::dark);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().detail.find("nothing.png' cannot be traced: "), std::string::npos);
  EXPECT_EQ(result.error().field, "image");
}

TEST_F(PngImage, RefusesWhatIsNoPngAndWhatIsDamaged) {
  EXPECT_NE(error_of(0, "GIF89a"), "");
  EXPECT_NE(error_of(45, std::string(8, '\0')), "");  // inside the pixels
}

// Width and height stand at bytes 16 and 20, their checksum at 29: taken from the format, so that
// the size is refused and not the damage.
TEST_F(PngImage, RefusesMorePixelsThanTheLimitBeforeItTakesMemory) {
  EXPECT_EQ(
      error_of(16, {"\x00\x00\x20\x00\x00\x00\x20\x01\x08\x00\x00\x00\x00\x9c\x9d\x46\x20", 17}),
      "'" + path() + "' cannot be traced: 8192 x 8193 pixels are beyond the limit of 67108864");
}

}  // namespace
}  // namespace earthwork::bot
