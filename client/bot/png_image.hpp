/// Reads a PNG picture as two colours.
#pragma once

#include <string>

#include "client/bot/bitmap.hpp"
#include "protocol/result.hpp"

namespace earthwork::bot {

enum class Ink { dark, light };

/// A pixel is set where its grey is below `threshold` (0 .. 256), or for Ink::light where it is
/// not. Grey is 0 .. 255: (299 red + 587 green + 114 blue) / 1000, rounded, of the pixel laid over
/// white with its opacity; every colour type and depth is brought to 8 bits first, of 16 bits the
/// upper 8. Samples count as they stand: what the file says of gamma and colour space changes
/// nothing. Fails with a sentence naming the file when it cannot be read, is no PNG, or has more
/// than kMaxPixels, which is known before memory is taken.
[[nodiscard]] protocol::Result<Bitmap> read_png(const std::string& path, int threshold, Ink ink);

}  // namespace earthwork::bot
