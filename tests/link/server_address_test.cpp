// SERVER: what is read from it, and what is refused.
#include "client/link/server_address.hpp"

#include <gtest/gtest.h>

namespace earthwork::link {
namespace {

std::string error_of(std::string_view url) {
  const auto result = parse_server(url);
  return result ? "" : result.error().detail;
}

TEST(ServerAddress, IsHostAndPort) {
  EXPECT_EQ(parse_server("http://127.0.0.1:8080"), (ServerAddress{"127.0.0.1", 8080}));
  EXPECT_EQ(parse_server("http://localhost:65535/"), (ServerAddress{"localhost", 65535}));
  EXPECT_EQ(parse_server("HTTP://maps.example"), (ServerAddress{"maps.example", 80}));
}

TEST(ServerAddress, KeepsAnIpv6AddressWithoutItsBrackets) {
  const auto address = parse_server("http://[::1]:8080");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->host, "::1");
  EXPECT_EQ(address->host_header(), "[::1]:8080");
  EXPECT_EQ(address->text(), "http://[::1]:8080");
}

TEST(ServerAddress, SaysWhatIsWrong) {
  EXPECT_EQ(
      error_of("https://localhost:8080"),
      "server: 'https://localhost:8080' is not http://HOST:PORT: only http:// is spoken here");
  EXPECT_EQ(error_of("http://a:1/maps"),
            "server: 'http://a:1/maps' is not http://HOST:PORT: a path has no place in it");
  EXPECT_EQ(error_of("http://me@a:1"),
            "server: 'http://me@a:1' is not http://HOST:PORT: a user has no place in it");
  EXPECT_EQ(error_of("http://a:1?x"),
            "server: 'http://a:1?x' is not http://HOST:PORT: a query has no place in it");
  EXPECT_EQ(error_of("http://:8080"),
            "server: 'http://:8080' is not http://HOST:PORT: the host is missing");
  EXPECT_EQ(error_of("http://a:65536"),
            "server: 'http://a:65536' is not http://HOST:PORT: the port is not 1 .. 65535");
  EXPECT_EQ(error_of("http://a:0"),
            "server: 'http://a:0' is not http://HOST:PORT: the port is not 1 .. 65535");
  EXPECT_EQ(error_of("localhost"), "server: 'localhost' is not http://HOST:PORT: it is no URL");
  EXPECT_EQ(error_of(""), "server: '' is not http://HOST:PORT: it is no URL");
  EXPECT_EQ(parse_server("").error().field, "server");
}

TEST(ServerAddress, RefusesWhatIsTooLong) {
  EXPECT_TRUE(parse_server("http://" + std::string(293, 'a')));
  EXPECT_NE(error_of("http://" + std::string(294, 'a')).find("longer than 300"), std::string::npos);
}

}  // namespace
}  // namespace earthwork::link
