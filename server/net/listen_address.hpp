/// Where a server listens: HOST:PORT.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace earthwork::net {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< An IPv4 or IPv6 address without brackets, or "localhost".
  std::uint16_t port = 8080;       ///< 0 lets the system pick a free one.

  /// The host as a URL has it: an IPv6 address in brackets.
  [[nodiscard]] std::string host_text() const;
  /// HOST:PORT.
  [[nodiscard]] std::string text() const;
  /// Reachable from this machine only.
  [[nodiscard]] bool loopback() const;
  /// The host as an address: "localhost" is 127.0.0.1.
  [[nodiscard]] std::string numeric_host() const;
  friend bool operator==(const ListenAddress&, const ListenAddress&) = default;
};

/// HOST:PORT, [IPV6]:PORT. Fails with bad_field for anything else, host names other than localhost
/// included.
[[nodiscard]] protocol::Result<ListenAddress> parse_listen_address(std::string_view text);

}  // namespace earthwork::net
