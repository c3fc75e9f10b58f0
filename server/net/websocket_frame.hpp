/// Whole messages as the server of a WebSocket sends them: one frame each, neither masked nor
/// compressed. Source: RFC 6455, section 5.2.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace earthwork::net {

enum class Kind { text, binary };

/// Appends what comes before a message's `payload_bytes` bytes.
void append_head(std::string& out, Kind kind, std::size_t payload_bytes);
void append_message(std::string& out, Kind kind, std::string_view payload);

/// A ping without payload, as a whole.
inline constexpr std::string_view kPing{"\x89\x00", 2};

}  // namespace earthwork::net
