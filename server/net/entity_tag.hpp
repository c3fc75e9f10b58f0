/// Whether a client has what it asks for already.
#pragma once

#include <string_view>

namespace earthwork::net {

/// Whether an If-None-Match header has `tag` in its list, or '*'. Source: RFC 9110, 13.1.2.
[[nodiscard]] bool names_tag(std::string_view header, std::string_view tag);

}  // namespace earthwork::net
