#include "server/net/websocket_frame.hpp"

namespace earthwork::net {
namespace {

constexpr int kFinal = 0x80, kText = 1, kBinary = 2;
constexpr std::size_t kMaxTiny = 125, kMaxUsual = 0xffff;
constexpr char kTwoBytesFollow = 126, kEightBytesFollow = 127;

}  // namespace

void append_head(std::string& out, Kind kind, std::size_t payload_bytes) {
  out += static_cast<char>(kFinal | (kind == Kind::text ? kText : kBinary));
  if (payload_bytes <= kMaxTiny) {
    out += static_cast<char>(payload_bytes);
    return;
  }
  const bool usual = payload_bytes <= kMaxUsual;
  out += usual ? kTwoBytesFollow : kEightBytesFollow;
  for (int shift = usual ? 8 : 56; shift >= 0; shift -= 8)
    out += static_cast<char>(payload_bytes >> shift & 0xff);
}

void append_message(std::string& out, Kind kind, std::string_view payload) {
  append_head(out, kind, payload.size());
  out += payload;
}

}  // namespace earthwork::net
