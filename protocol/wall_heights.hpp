/// The heights between which a layer's walls stand.
#pragma once

#include <array>

#include "protocol/json_fields.hpp"

namespace earthwork::protocol {

/// The field "wall": [bottom, top] in map units, bottom < top also as 32-bit floats, both within
/// kMaxHeight.
std::array<double, 2> read_wall_heights(JsonFields& in);

}  // namespace earthwork::protocol
