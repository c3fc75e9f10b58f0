/// Black and white pictures as PNG files.
#pragma once

#include <string>

#include "protocol/result.hpp"
#include "server/room/states_picture.hpp"

namespace earthwork::net {

/// A greyscale PNG of one bit a pixel. Fails with internal when libpng does.
[[nodiscard]] protocol::Result<std::string> encode_png(const room::StatesPicture& picture);

}  // namespace earthwork::net
