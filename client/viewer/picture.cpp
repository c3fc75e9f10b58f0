#include "client/viewer/picture.hpp"

#include <cstddef>
#include <string_view>

namespace earthwork::viewer {
namespace {

constexpr float kGrey = 128.0F / 255;

/// The value of a hexadecimal digit; -1 for anything else.
int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Color color_of(std::string_view hash_rrggbb, float opacity) {
  Color color{kGrey, kGrey, kGrey, opacity};
  if (hash_rrggbb.size() != 7 || hash_rrggbb[0] != '#') return color;
  Color read = color;
  for (std::size_t i = 0; i < 3; ++i) {
    const int high = digit(hash_rrggbb[1 + 2 * i]), low = digit(hash_rrggbb[2 + 2 * i]);
    if (high < 0 || low < 0) return color;
    read[i] = static_cast<float>(16 * high + low) / 255;
  }
  return read;
}

}  // namespace earthwork::viewer
