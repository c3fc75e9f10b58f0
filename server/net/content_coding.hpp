/// Which coding of a body a client takes.
#pragma once

#include <string_view>

namespace earthwork::net {

/// Whether a client that sent this Accept-Encoding header is best served with gzip: it takes gzip,
/// by its name or by '*', and does not like the plain bytes better. A weight that is none counts as
/// 0, which is a no. Source: RFC 9110, 12.4.2 and 12.5.3.
[[nodiscard]] bool prefers_gzip(std::string_view accept_encoding);

}  // namespace earthwork::net
