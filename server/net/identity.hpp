/// Who a session is: to people, and in the log.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace earthwork::net {

/// What events keep of a key, and show to everybody: enough to know its holder again, and nothing
/// to find the key by. The first 8 bytes, little-endian, of the 16-byte BLAKE2b hash of the key's
/// text under a fixed hash key of this project, so that no table of other hashes helps. The same
/// for the same key in every build: maps keep it.
[[nodiscard]] std::uint64_t author_of(std::string_view key);

/// A colour for somebody who chose none: "#rrggbb", the same for the same session name.
[[nodiscard]] std::string color_for(std::string_view session);

}  // namespace earthwork::net
