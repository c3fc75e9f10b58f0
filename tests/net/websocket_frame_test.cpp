// The head of a message: each of its three lengths, at its limits.
#include "server/net/websocket_frame.hpp"

#include <gtest/gtest.h>

#include "tests/net/wire_messages.hpp"

namespace earthwork::net {
namespace {

std::string head(Kind kind, std::size_t payload_bytes) {
  std::string out;
  append_head(out, kind, payload_bytes);
  return out;
}

TEST(WebSocketFrame, HasTheShortestLengthThatFits) {
  EXPECT_EQ(head(Kind::text, 0), std::string("\x81\x00", 2));
  EXPECT_EQ(head(Kind::binary, 125), "\x82\x7d");
  EXPECT_EQ(head(Kind::binary, 126), std::string("\x82\x7e\x00\x7e", 4));
  EXPECT_EQ(head(Kind::text, 65535), "\x81\x7e\xff\xff");
  EXPECT_EQ(head(Kind::text, 65536), std::string("\x81\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10));
  EXPECT_EQ(head(Kind::text, 0x12345678).substr(6), "\x12\x34\x56\x78");
}

TEST(WebSocketFrame, AppendsBehindWhatIsThere) {
  std::string out = "before";
  append_message(out, Kind::text, "one");
  append_message(out, Kind::binary, std::string(70'000, 'x'));
  ASSERT_TRUE(out.starts_with("before"));
  const auto messages = wire_messages(std::string_view(out).substr(6));
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].bytes, "one");
  EXPECT_EQ(messages[1].kind, Kind::binary);
  EXPECT_EQ(messages[1].bytes, std::string(70'000, 'x'));
}

}  // namespace
}  // namespace earthwork::net
