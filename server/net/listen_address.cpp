#include "server/net/listen_address.hpp"

#include <arpa/inet.h>

#include <charconv>
#include <cstring>

namespace earthwork::net {
namespace {

bool is_v4(const std::string& host) {
  in_addr address{};
  return inet_pton(AF_INET, host.c_str(), &address) == 1;
}
bool is_v6(const std::string& host) {
  in6_addr address{};
  return inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

}  // namespace

std::string ListenAddress::host_text() const {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::string ListenAddress::text() const { return host_text() + ":" + std::to_string(port); }

bool ListenAddress::loopback() const {
  if (host == "localhost") return true;
  if (in_addr v4{}; inet_pton(AF_INET, host.c_str(), &v4) == 1)
    return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6{};
  return inet_pton(AF_INET6, host.c_str(), &v6) == 1 &&
         std::memcmp(&v6, &in6addr_loopback, sizeof v6) == 0;
}

std::string ListenAddress::numeric_host() const { return host == "localhost" ? "127.0.0.1" : host; }

protocol::Result<ListenAddress> parse_listen_address(std::string_view text) {
  const auto refuse = [&] {
    return protocol::fail(protocol::Code::bad_field,
                          "'" + std::string(text.substr(0, 80)) +
                              "' is no HOST:PORT; the host is an IP address or localhost, the "
                              "port 0 .. 65535",
                          "listen");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return refuse();

  ListenAddress address;
  address.host = text.substr(0, colon);
  const bool bracketed = address.host.size() > 2 && address.host.front() == '[';
  if (bracketed) {
    if (address.host.back() != ']') return refuse();
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  const bool host_valid =
      bracketed ? is_v6(address.host) : address.host == "localhost" || is_v4(address.host);
  if (!host_valid) return refuse();

  const std::string_view port = text.substr(colon + 1);
  const char* end = port.data() + port.size();
  const auto [last, error] = std::from_chars(port.data(), end, address.port);
  if (error != std::errc{} || last != end) return refuse();
  return address;
}

}  // namespace earthwork::net
