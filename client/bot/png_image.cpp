#include "client/bot/png_image.hpp"

#include <png.h>

#include <array>
#include <cerrno>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <system_error>
#include <vector>

namespace earthwork::bot {
namespace {

using protocol::Code;

constexpr int kWhite = 255;
constexpr std::uint32_t kMaxSide = 1'000'000;  // of the world in voxels

tl::unexpected<protocol::Failure> refuse(const std::string& path, const std::string& why) {
  return protocol::fail(Code::bad_field, "'" + path + "' cannot be traced: " + why, "image");
}

/// A file that libpng reads. An error inside libpng jumps back into the member function that called
/// it, past every frame between: those functions have no objects to destroy, and return false.
class PngReader {
 public:
  explicit PngReader(const std::string& path) : file_(std::fopen(path.c_str(), "rb")) {
    if (!file_) {
      say(std::generic_category().message(errno).c_str());
      return;
    }
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, failed, warned);
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) say("there is not enough memory");
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() {
    png_destroy_read_struct(&png_, &info_, nullptr);
    if (file_) std::fclose(file_);
  }

  /// Reads up to the pixels and asks for samples of 8 bits: grey or red, green and blue, perhaps
  /// followed by opacity. Samples are kept as they stand, of 16 bits the upper 8.
  bool read_header() {
    if (!info_ || setjmp(png_jmpbuf(png_))) return false;
    png_init_io(png_, file_);
    png_read_info(png_, info_);
    png_set_expand(png_);
    png_set_strip_16(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  std::uint32_t width() const { return png_get_image_width(png_, info_); }
  std::uint32_t height() const { return png_get_image_height(png_, info_); }
  std::size_t channels() const { return png_get_channels(png_, info_); }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

  /// `rows` are height() pointers to row_bytes() each.
  bool read_pixels(std::uint8_t** rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    return true;
  }
  /// Why one of them failed.
  const char* error() const { return error_.data(); }

 private:
  void say(const char* why) { std::snprintf(error_.data(), error_.size(), "%s", why); }
  [[noreturn]] static void failed(png_structp png, const char* why) {
    static_cast<PngReader*>(png_get_error_ptr(png))->say(why);
    png_longjmp(png, 1);
  }
  static void warned(png_structp, const char*) {}

  std::FILE* file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, 256> error_{};
};

int over_white(int value, int opacity) {
  return (value * opacity + kWhite * (kWhite - opacity) + kWhite / 2) / kWhite;
}

/// Of a pixel with grey or with red, green and blue, perhaps followed by opacity.
int grey(const std::uint8_t* pixel, std::size_t channels) {
  const int opacity = channels % 2 == 0 ? pixel[channels - 1] : kWhite;
  if (channels < 3) return over_white(pixel[0], opacity);
  const int red = over_white(pixel[0], opacity), green = over_white(pixel[1], opacity),
            blue = over_white(pixel[2], opacity);
  return (299 * red + 587 * green + 114 * blue + 500) / 1000;
}

}  // namespace

protocol::Result<Bitmap> read_png(const std::string& path, int threshold, Ink ink) {
  PngReader png(path);
  if (!png.read_header()) return refuse(path, png.error());
  if (png.width() > kMaxSide || png.height() > kMaxSide ||
      std::size_t{png.width()} * png.height() > kMaxPixels)
    return refuse(path, std::to_string(png.width()) + " x " + std::to_string(png.height()) +
                            " pixels are beyond the limit of " + std::to_string(kMaxPixels));
  std::vector<std::uint8_t> samples(png.row_bytes() * png.height());
  std::vector<std::uint8_t*> rows(png.height());
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = &samples[y * png.row_bytes()];
  if (!png.read_pixels(rows.data())) return refuse(path, png.error());

  Bitmap out(static_cast<int>(png.width()), static_cast<int>(png.height()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool dark = grey(&samples[i * png.channels()], png.channels()) < threshold;
    out[i] = dark == (ink == Ink::dark);
  }
  return out;
}

}  // namespace earthwork::bot
