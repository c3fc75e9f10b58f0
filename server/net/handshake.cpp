#include "server/net/handshake.hpp"

#include <algorithm>
#include <string_view>

namespace earthwork::net {
namespace {

using protocol::Code;

constexpr const char* kVersion = "13";

bool is_base64(char c) {
  return ('A' <= c && c <= 'Z') || ('a' <= c && c <= 'z') || ('0' <= c && c <= '9') || c == '+' ||
         c == '/';
}

/// Whether it is 16 bytes in base64: 22 digits and two fillers.
bool is_key(std::string_view key) {
  return key.size() == 24 && key.ends_with("==") &&
         std::all_of(key.begin(), key.end() - 2, is_base64);
}

}  // namespace

std::optional<HttpResponse> refuse_handshake(const Handshake& handshake) {
  if (handshake.version != kVersion) {
    HttpResponse response = problem(
        426, {Code::bad_version, "Sec-WebSocket-Version: 13 is needed", "Sec-WebSocket-Version"});
    response.headers.emplace_back("Sec-WebSocket-Version", kVersion);
    return response;
  }
  if (!handshake.key || !is_key(*handshake.key))
    return problem(400, {Code::bad_field, "Sec-WebSocket-Key: 16 bytes in base64 are needed",
                         "Sec-WebSocket-Key"});
  if (!handshake.offers_subprotocol)
    return problem(400, {Code::bad_version, "Sec-WebSocket-Protocol: earthwork.v1 is needed",
                         "Sec-WebSocket-Protocol"});
  return std::nullopt;
}

}  // namespace earthwork::net
