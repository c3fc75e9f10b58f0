#include "client/bot/png_image.hpp"

#include <png.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace earthwork::bot {
namespace {

using protocol::Code;

constexpr int kWhite = 255;
constexpr std::uint32_t kMaxSide = 1'000'000;  // of the world in voxels

struct FreeImage {
  void operator()(png_image* image) const { png_image_free(image); }
};

tl::unexpected<protocol::Failure> refuse(const std::string& path, const std::string& why) {
  return protocol::fail(Code::bad_field, "'" + path + "' cannot be traced: " + why, "image");
}

int over_white(int value, int opacity) {
  return (value * opacity + kWhite * (kWhite - opacity) + kWhite / 2) / kWhite;
}

/// Of a pixel with grey and opacity, or with red, green, blue and opacity.
int grey(const std::uint8_t* pixel, bool colour) {
  if (!colour) return over_white(pixel[0], pixel[1]);
  const int red = over_white(pixel[0], pixel[3]), green = over_white(pixel[1], pixel[3]),
            blue = over_white(pixel[2], pixel[3]);
  return (299 * red + 587 * green + 114 * blue + 500) / 1000;
}

protocol::Result<Bitmap> decode(png_image& image, const std::string& path, int threshold, Ink ink) {
  if (image.width > kMaxSide || image.height > kMaxSide ||
      std::size_t{image.width} * image.height > kMaxPixels)
    return refuse(path, std::to_string(image.width) + " x " + std::to_string(image.height) +
                            " pixels are beyond the limit of " + std::to_string(kMaxPixels));
  const bool colour = (image.format & PNG_FORMAT_FLAG_COLOR) != 0;
  image.format = colour ? PNG_FORMAT_RGBA : PNG_FORMAT_GA;
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  std::vector<std::uint8_t> samples(PNG_IMAGE_SIZE(image));
  if (!png_image_finish_read(&image, nullptr, samples.data(), 0, nullptr))
    return refuse(path, image.message);

  Bitmap out(static_cast<int>(image.width), static_cast<int>(image.height));
  const std::size_t channels = colour ? 4 : 2;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool dark = grey(&samples[i * channels], colour) < threshold;
    out[i] = dark == (ink == Ink::dark);
  }
  return out;
}

}  // namespace

protocol::Result<Bitmap> read_png(const std::string& path, int threshold, Ink ink) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, FreeImage> freed_at_the_end(&image);
  if (!png_image_begin_read_from_file(&image, path.c_str())) return refuse(path, image.message);
  return decode(image, path, threshold, ink);
}

}  // namespace earthwork::bot
