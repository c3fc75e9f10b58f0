#include "server/net/listen_address.hpp"

#include <boost/asio/ip/address.hpp>
#include <charconv>

namespace earthwork::net {
namespace {

namespace ip = boost::asio::ip;

bool is_v4(const std::string& host) {
  boost::system::error_code error;
  ip::make_address_v4(host, error);
  return !error;
}
bool is_v6(const std::string& host) {
  boost::system::error_code error;
  ip::make_address_v6(host, error);
  return !error;
}

}  // namespace

std::string ListenAddress::host_text() const {
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::string ListenAddress::text() const { return host_text() + ":" + std::to_string(port); }

bool ListenAddress::loopback() const {
  if (host == "localhost") return true;
  boost::system::error_code error;
  const ip::address address = ip::make_address(host, error);
  return !error && address.is_loopback();
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
