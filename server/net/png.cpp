#include "server/net/png.hpp"

#include <png.h>

#include <csetjmp>

namespace earthwork::net {
namespace {

void append(png_structp png, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
}
void flush_nothing(png_structp) {}

// What goes wrong is told by the result, and not on stderr.
[[noreturn]] void fail_quietly(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void warn_quietly(png_structp, png_const_charp) {}

/// libpng leaves a failed call by longjmp, so nothing in here has a destructor.
bool write_all(png_structp png, png_infop info, const room::StatesPicture& picture,
               std::string& out) {
  if (setjmp(png_jmpbuf(png))) return false;  // NOLINT: libpng's only way to report
  png_set_write_fn(png, &out, append, flush_nothing);
  png_set_compression_level(png,
                            3);  // of 9: nearly as small on such pictures, several times faster
  png_set_IHDR(png, info, picture.width, picture.height, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (std::size_t y = 0; y < picture.height; ++y)
    png_write_row(png, picture.bits.data() + y * picture.row_bytes());
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

protocol::Result<std::string> encode_png(const room::StatesPicture& picture) {
  const auto failed = [] {
    return protocol::fail(protocol::Code::internal, "the picture could not be encoded");
  };
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail_quietly, warn_quietly);
  if (!png) return failed();
  // libpng's own limit is a million pixels a side; ours is on the product.
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_infop info = png_create_info_struct(png);
  std::string out;
  const bool written = info && write_all(png, info, picture, out);
  png_destroy_write_struct(&png, &info);
  if (!written) return failed();
  return out;
}

}  // namespace earthwork::net
