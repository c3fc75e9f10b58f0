/// Covers the set pixels of a picture with squares.
#pragma once

#include <span>
#include <vector>

#include "client/bot/bitmap.hpp"

namespace earthwork::bot {

/// Pixels x .. x + side - 1, y .. y + side - 1.
struct PixelSquare {
  int x = 0, y = 0, side = 1;
  friend bool operator==(const PixelSquare&, const PixelSquare&) = default;
};

/// Squares whose union holds every pixel set in `wanted` and none that is clear in `allowed`;
/// they may overlap. The two are of one size, and what is wanted is allowed. `sides` falls from
/// one to the next and ends with 1; a side is used wherever it covers something that larger ones
/// could not, so the squares come largest first, those of one side by rows.
///
/// Greedy: a few thousand squares for a coastline of tens of thousands of pixels. Takes time
/// proportional to pixels times sides, and four bytes a pixel.
[[nodiscard]] std::vector<PixelSquare> cover_with_squares(const Bitmap& wanted,
                                                          const Bitmap& allowed,
                                                          std::span<const int> sides);

}  // namespace earthwork::bot
