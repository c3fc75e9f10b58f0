#include "client/link/server_address.hpp"

#include <boost/url/parse.hpp>
#include <boost/url/url_view.hpp>

namespace earthwork::link {
namespace {

constexpr std::size_t kMaxServerBytes = 300;  // a host name has 253 characters at most

std::string plain_host(const boost::urls::url_view& url) {
  if (url.host_type() == boost::urls::host_type::ipv6) return std::string(url.host_address());
  return std::string(url.host());
}

/// What about the URL is not http://HOST:PORT; empty when nothing is.
std::string_view fault_of(const boost::urls::url_view& url) {
  if (url.scheme_id() != boost::urls::scheme::http) return "only http:// is spoken here";
  if (url.host().empty()) return "the host is missing";
  if (url.has_userinfo()) return "a user has no place in it";
  if (url.encoded_path() != "" && url.encoded_path() != "/") return "a path has no place in it";
  if (url.has_query() || url.has_fragment()) return "a query has no place in it";
  if (url.has_port() && url.port_number() == 0) return "the port is not 1 .. 65535";
  return {};
}

}  // namespace

std::string ServerAddress::host_header() const {
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::string ServerAddress::text() const { return "http://" + host_header(); }

protocol::Result<ServerAddress> parse_server(std::string_view url) {
  const auto refuse = [&](std::string_view why) {
    return protocol::fail(protocol::Code::bad_field,
                          "server: '" + std::string(url.substr(0, kMaxServerBytes)) +
                              "' is not http://HOST:PORT: " + std::string(why),
                          "server");
  };
  if (url.size() > kMaxServerBytes) return refuse("it is longer than 300 characters");
  const auto parsed = boost::urls::parse_uri(boost::urls::string_view(url.data(), url.size()));
  if (!parsed) return refuse("it is no URL");
  if (const auto fault = fault_of(*parsed); !fault.empty()) return refuse(fault);
  return ServerAddress{.host = plain_host(*parsed),
                       .port = parsed->has_port() ? parsed->port_number() : std::uint16_t{80}};
}

}  // namespace earthwork::link
