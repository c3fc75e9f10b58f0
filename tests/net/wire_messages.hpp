/// What a WebSocket carries, taken apart again by rules written a second time.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "server/net/websocket_frame.hpp"

namespace earthwork::net {

struct WireMessage {
  Kind kind = Kind::text;
  std::string bytes;
};

/// Whole unmasked messages of one frame each, and nothing else.
inline std::vector<WireMessage> wire_messages(std::string_view bytes) {
  const auto number = [&](std::size_t at, std::size_t count) {
    std::uint64_t value = 0;
    for (; count > 0; ++at, --count) value = value << 8 | static_cast<unsigned char>(bytes.at(at));
    return value;
  };
  std::vector<WireMessage> messages;
  while (!bytes.empty()) {
    const std::uint64_t first = number(0, 1);
    EXPECT_TRUE(first == 0x81 || first == 0x82) << first;
    const std::uint64_t form = number(1, 1);
    const std::size_t head = form == 126 ? 4 : form == 127 ? 10 : 2;
    const std::uint64_t length = form < 126 ? form : number(2, head - 2);
    EXPECT_LE(head + length, bytes.size());
    messages.push_back(
        {first == 0x81 ? Kind::text : Kind::binary, std::string(bytes.substr(head, length))});
    bytes.remove_prefix(head + length);
  }
  return messages;
}

}  // namespace earthwork::net
