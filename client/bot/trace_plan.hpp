/// From a picture to the edits that paint it: few, each with a long path of equal squares.
#pragma once

#include <vector>

#include "client/bot/bitmap.hpp"
#include "protocol/edit.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

/// What is known of the ground under the picture.
enum class Ground { empty, unknown };

/// Edits on layer 0 after which voxel (x, height - 1 - y) is filled exactly where pixel (x, y) is
/// set, and no other voxel was touched. Each passes `protocol::check_edit` for `settings`. A
/// square of k x k pixels is stamped with radius k / 2, so that outlines lie half way between
/// voxels and depend on the picture alone.
///
/// Small holes are filled over and emptied again, unknown ground is emptied first. A pure function.
[[nodiscard]] std::vector<protocol::Edit> plan_trace(const Bitmap& picture, Ground ground,
                                                     const protocol::MapSettings& settings);

}  // namespace earthwork::bot
