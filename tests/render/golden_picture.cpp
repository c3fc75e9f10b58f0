#include "tests/render/golden_picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdlib>
#include <optional>

namespace earthwork::viewer {
namespace {

png_image head_of(const Pixels& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(pixels.width);
  image.height = static_cast<png_uint_32>(pixels.height);
  image.format = PNG_FORMAT_RGBA;
  return image;
}

void write(const std::string& path, const Pixels& pixels) {
  png_image image = head_of(pixels);
  ASSERT_TRUE(png_image_write_to_file(&image, path.c_str(), 0, pixels.rgba.data(), 0, nullptr))
      << path << ": " << image.message;
}

std::optional<Pixels> read(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&image, path.c_str())) return std::nullopt;
  image.format = PNG_FORMAT_RGBA;
  Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  pixels.rgba.resize(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, pixels.rgba.data(), 0, nullptr)) return std::nullopt;
  return pixels;
}

}  // namespace

std::size_t differing(const Pixels& a, const Pixels& b) {
  if (a.width != b.width || a.height != b.height) return a.rgba.size() / 4;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    bool differs = false;
    for (std::size_t c = 0; c < 4; ++c)
      differs = differs || std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}) > 2;
    count += differs ? 1 : 0;
  }
  return count;
}

void expect_golden(const std::string& name, const Pixels& drawn) {
  const std::string path =
      std::string(EARTHWORK_SOURCE_DIR) + "/tests/render/golden/" + name + ".png";
  if (std::getenv("EARTHWORK_UPDATE")) write(path, drawn);
  const auto kept = read(path);
  ASSERT_TRUE(kept) << path << " is no picture; EARTHWORK_UPDATE=1 writes it";
  const std::size_t differ = differing(*kept, drawn);
  if (differ * 500 <= drawn.rgba.size() / 4) return;
  const std::string instead = testing::TempDir() + "earthwork_" + name + ".png";
  write(instead, drawn);
  ADD_FAILURE() << differ << " pixels differ from " << path << "; look at " << instead
                << ", then run with EARTHWORK_UPDATE=1";
}

}  // namespace earthwork::viewer
