// HOST:PORT.
#include "server/net/listen_address.hpp"

#include <gtest/gtest.h>

namespace earthwork::net {
namespace {

TEST(ListenAddress, ReadsAddressesAndPorts) {
  EXPECT_EQ(parse_listen_address("127.0.0.1:8080"), (ListenAddress{"127.0.0.1", 8080}));
  EXPECT_EQ(parse_listen_address("localhost:0"), (ListenAddress{"localhost", 0}));
  EXPECT_EQ(parse_listen_address("[::1]:65535"), (ListenAddress{"::1", 65535}));
}

TEST(ListenAddress, RefusesEverythingElse) {
  for (const char* text :
       {"", ":", ":80", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1",
        "127.0.0.1:80x", "127.0.0.1: 80", "::1:80", "[::1]", "[::1:80", "[127.0.0.1]:80",
        "example.com:80", "256.0.0.1:80", "[]:80", "http://127.0.0.1:80"}) {
    const auto read = parse_listen_address(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, protocol::Code::bad_field);
  }
}

TEST(ListenAddress, IsWrittenAsAUrlHasIt) {
  EXPECT_EQ((ListenAddress{"::1", 80}).text(), "[::1]:80");
  EXPECT_EQ((ListenAddress{"127.0.0.1", 80}).text(), "127.0.0.1:80");
  EXPECT_EQ((ListenAddress{"localhost", 80}).numeric_host(), "127.0.0.1");
}

TEST(ListenAddress, KnowsWhatOtherMachinesCannotReach) {
  for (const char* host : {"127.0.0.1", "127.8.9.10", "localhost", "::1"})
    EXPECT_TRUE((ListenAddress{host, 1}).loopback()) << host;
  for (const char* host : {"0.0.0.0", "::", "192.168.0.1", "128.0.0.1", "::2"})
    EXPECT_FALSE((ListenAddress{host, 1}).loopback()) << host;
}

}  // namespace
}  // namespace earthwork::net
