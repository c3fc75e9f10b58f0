/// Who a session is: to people, and in the log.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace earthwork::net {

/// What events keep of a key: enough to know it again, not enough to be it.
[[nodiscard]] std::uint64_t author_of(std::string_view key);

/// A colour for somebody who chose none: "#rrggbb", the same for the same session name.
[[nodiscard]] std::string color_for(std::string_view session);

}  // namespace earthwork::net
