/// earthwork-bot trace: a picture, painted one voxel a pixel.
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>

#include "client/bot/exit_code.hpp"
#include "client/bot/png_image.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

struct TraceOptions {
  std::string image;  ///< A path.
  std::string server, map;
  bool create = false;
  int threshold = 128;  ///< 0 .. 256.
  Ink ink = Ink::dark;
  int resolution = 32;                         ///< Of a map that is made.
  std::chrono::milliseconds patience{60'000};  ///< As of PaintOptions.
};

/// Prints the report as one line on `out`, and what is to be said to people on `log`. Blocks.
[[nodiscard]] ExitCode trace_command(const TraceOptions& options, std::ostream& out,
                                     std::ostream& log);

/// A bounded map with one layer, just large enough for the picture with its lower left pixel at
/// voxel (0, 0).
[[nodiscard]] protocol::MapSettings settings_for(const Bitmap& picture, int resolution);

/// Whether the picture's voxels lie inside the map's bounds; out_of_range otherwise.
[[nodiscard]] protocol::Result<void> check_fits(const Bitmap& picture,
                                                const protocol::MapSettings& settings);

}  // namespace earthwork::bot
