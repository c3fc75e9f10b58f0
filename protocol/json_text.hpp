/// JSON from strangers: parsed within limits, before anything looks at what it says.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "protocol/result.hpp"

namespace earthwork::protocol {

/// JSON of at most `max_bytes` and kMaxJsonDepth levels (an object in an object is two), in valid
/// UTF-8. Depth is checked while the text is read, before a deeper tree exists. too_large or
/// bad_json otherwise; bad_field for a number beyond float64. Of equal keys the last one counts.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, std::size_t max_bytes);

}  // namespace earthwork::protocol
