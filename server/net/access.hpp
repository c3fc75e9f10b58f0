/// Who may speak to the server at all: browsers of other sites may not, whatever name they have
/// given this machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"
#include "server/net/listen_address.hpp"

namespace earthwork::net {

/// The names under which the server may be addressed. Any thread.
class Access {
 public:
  /// The listening address, localhost, 127.0.0.1 and [::1], each with `listen.port`, and `extra`
  /// ("HOST", with any port or none, or "HOST:PORT").
  Access(const ListenAddress& listen, const std::vector<std::string>& extra);

  /// Checks the Host and Origin headers of one request. A missing or unknown Host and an Origin
  /// that is none of the names are bad_field.
  [[nodiscard]] protocol::Result<void> check(const std::optional<std::string>& host,
                                             const std::optional<std::string>& origin) const;

 private:
  [[nodiscard]] bool allowed(std::string_view host) const;

  std::vector<std::string> hosts_, any_port_;  // lower case
};

}  // namespace earthwork::net
