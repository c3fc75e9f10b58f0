/// What has to be right in a request before it may become a WebSocket (RFC 6455, 4.2.1).
#pragma once

#include <optional>
#include <string>

#include "server/net/http_message.hpp"

namespace earthwork::net {

/// Headers of a request that asks for an upgrade. One that came several times is its values with
/// ", " between them; one that was not sent is nullopt.
struct Handshake {
  std::optional<std::string> version, key;
  bool offers_subprotocol = false;  ///< earthwork.v1, among others or alone.
};

/// A problem document with the header that is wrong; nothing when the handshake may go on. Another
/// version is answered 426 with the right one, everything else 400.
[[nodiscard]] std::optional<HttpResponse> refuse_handshake(const Handshake& handshake);

}  // namespace earthwork::net
