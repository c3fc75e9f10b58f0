/// A picture in two colours: what is to be filled, and what is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace earthwork::bot {

/// What a picture may have; each side at most 10^6.
inline constexpr std::size_t kMaxPixels = std::size_t{1} << 26;

/// Row 0 is the top one, column 0 the left one.
class Bitmap {
 public:
  /// All clear. Both sides at least 1, together at most kMaxPixels.
  Bitmap(int width, int height)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool at(int x, int y) const { return pixels_[index(x, y)] != 0; }
  void set(int x, int y, bool value) { pixels_[index(x, y)] = value; }
  /// The place of pixel (x, y) in rows one after the other.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  /// By index; 0 or 1.
  std::uint8_t& operator[](std::size_t index) { return pixels_[index]; }
  std::uint8_t operator[](std::size_t index) const { return pixels_[index]; }
  friend bool operator==(const Bitmap&, const Bitmap&) = default;

 private:
  int width_, height_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace earthwork::bot
