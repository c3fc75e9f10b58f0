#include "client/bot/square_cover.hpp"

#include <algorithm>
#include <cstdint>

namespace earthwork::bot {
namespace {

constexpr int kNone = -1;

/// For each pixel the side of the largest allowed square with its upper left corner there, by the
/// recurrence over the three neighbours to the right and below; sides beyond `longest` count as it.
std::vector<std::uint16_t> largest_squares(const Bitmap& allowed, int longest) {
  const int width = allowed.width(), height = allowed.height();
  std::vector<std::uint16_t> out(allowed.size());
  const auto at = [&](int x, int y) {
    return x < width && y < height ? int{out[allowed.index(x, y)]} : 0;
  };
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x) {
      if (!allowed.at(x, y)) continue;
      const int side = 1 + std::min({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
      out[allowed.index(x, y)] = static_cast<std::uint16_t>(std::min(side, longest));
    }
  return out;
}

class Cover {
 public:
  Cover(const Bitmap& wanted, const Bitmap& allowed, int longest)
      : missing_(wanted),
        room_(largest_squares(allowed, longest)),
        column_(static_cast<std::size_t>(wanted.width())) {}

  /// Places squares of this side by rows. A square that covers (x, y) has its corner at most
  /// side - 1 to the left and above; the one furthest to the lower right is taken, because above
  /// and to the left nothing is missing any more that this side could reach.
  void place(int side, std::vector<PixelSquare>& out) {
    std::fill(column_.begin(), column_.end(), Corner{});
    for (int y = 0; y < missing_.height(); ++y) {
      int corner_x = kNone;
      for (int x = 0; x < missing_.width(); ++x) {
        if (room_[missing_.index(x, y)] >= side) corner_x = x;
        Corner& corner = column_[static_cast<std::size_t>(x)];
        if (corner_x != kNone && corner_x > x - side) corner = {corner_x, y};
        if (!missing_.at(x, y) || corner.x == kNone || corner.y <= y - side) continue;
        put({corner.x, corner.y, side});
        out.push_back({corner.x, corner.y, side});
      }
    }
  }

 private:
  /// Of the lowest square so far that reaches a column.
  struct Corner {
    int x = kNone, y = kNone;
  };

  void put(const PixelSquare& square) {
    for (int y = square.y; y < square.y + square.side; ++y)
      for (int x = square.x; x < square.x + square.side; ++x) missing_.set(x, y, false);
  }

  Bitmap missing_;
  std::vector<std::uint16_t> room_;
  std::vector<Corner> column_;
};

}  // namespace

std::vector<PixelSquare> cover_with_squares(const Bitmap& wanted, const Bitmap& allowed,
                                            std::span<const int> sides) {
  std::vector<PixelSquare> out;
  Cover cover(wanted, allowed, sides.front());
  for (const int side : sides) cover.place(side, out);
  return out;
}

}  // namespace earthwork::bot
