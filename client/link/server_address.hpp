/// SERVER as the programs take it: http://HOST:PORT.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace earthwork::link {

struct ServerAddress {
  std::string host;  ///< A name or a numeric address, IPv6 without its brackets.
  std::uint16_t port = 80;

  /// HOST:PORT as a Host header has it, IPv6 in brackets.
  [[nodiscard]] std::string host_header() const;
  /// http://HOST:PORT, for messages to people.
  [[nodiscard]] std::string text() const;
  friend bool operator==(const ServerAddress&, const ServerAddress&) = default;
};

/// Reads http://HOST[:PORT][/]; without a port it is 80. Anything else in it, another scheme, a
/// path, a user, a query, is refused with bad_field and a sentence that says what.
[[nodiscard]] protocol::Result<ServerAddress> parse_server(std::string_view url);

}  // namespace earthwork::link
