#include "server/net/access.hpp"

#include <algorithm>
#include <cctype>

namespace earthwork::net {
namespace {

using protocol::Code;

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// "name" of "name:80", "[::1]" of "[::1]:80"; what has no port as it is.
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos) return host;
  const bool address = host.starts_with('[');
  if (address ? host.find(']', colon) != std::string_view::npos : host.find(':') != colon) {
    return host;
  }
  return host.substr(0, colon);
}

}  // namespace

Access::Access(const ListenAddress& listen, const std::vector<std::string>& extra) {
  for (const std::string& host :
       {listen.host, std::string("localhost"), std::string("127.0.0.1"), std::string("::1")}) {
    const ListenAddress address{host, listen.port};
    hosts_.push_back(lower(address.text()));
    // Browsers leave out the port that http has anyway.
    if (listen.port == 80) hosts_.push_back(lower(address.host_text()));
  }
  for (const std::string& host : extra) {
    const std::string name = lower(host);
    (without_port(name) == name ? any_port_ : hosts_).push_back(name);
  }
}

bool Access::allowed(std::string_view host) const {
  const std::string name = lower(host);
  const auto holds = [](const std::vector<std::string>& names, std::string_view wanted) {
    return std::find(names.begin(), names.end(), wanted) != names.end();
  };
  return holds(hosts_, name) || holds(any_port_, without_port(name));
}

protocol::Result<void> Access::check(const std::optional<std::string>& host,
                                     const std::optional<std::string>& origin) const {
  if (!host || !allowed(*host))
    return protocol::fail(Code::bad_field, "Host: not a name of this server; --allow-host adds one",
                          "Host");
  constexpr std::string_view kScheme = "http://";
  if (origin && (!origin->starts_with(kScheme) || !allowed(origin->substr(kScheme.size()))))
    return protocol::fail(Code::bad_field, "Origin: another site may not use this server",
                          "Origin");
  return {};
}

}  // namespace earthwork::net
