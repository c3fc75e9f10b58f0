// Host and Origin: this server's names only.
#include "server/net/access.hpp"

#include <gtest/gtest.h>

namespace earthwork::net {
namespace {

const Access kAccess({"127.0.0.1", 8080}, {"maps.example", "maps.example:8080"});

bool passes(std::optional<std::string> host, std::optional<std::string> origin = {}) {
  return kAccess.check(host, origin).has_value();
}

TEST(Access, KnowsItsOwnNames) {
  EXPECT_TRUE(passes("127.0.0.1:8080"));
  EXPECT_TRUE(passes("localhost:8080"));
  EXPECT_TRUE(passes("LocalHost:8080"));
  EXPECT_TRUE(passes("[::1]:8080"));
  EXPECT_TRUE(passes("maps.example"));
}

TEST(Access, RefusesOtherNamesAndPorts) {
  EXPECT_FALSE(passes("evil.example:8080"));
  EXPECT_FALSE(passes("127.0.0.1"));
  EXPECT_FALSE(passes("127.0.0.1:8081"));
  EXPECT_FALSE(passes("localhost:8080.evil.example"));
  EXPECT_FALSE(passes(""));
  EXPECT_FALSE(passes(std::nullopt));
}

TEST(Access, LetsAPageOfItsOwnSpeak) {
  EXPECT_TRUE(passes("localhost:8080", "http://localhost:8080"));
  EXPECT_TRUE(passes("maps.example", "http://maps.example"));
}

TEST(Access, RefusesPagesOfOtherSites) {
  EXPECT_FALSE(passes("localhost:8080", "http://evil.example"));
  EXPECT_FALSE(passes("localhost:8080", "http://localhost:3000"));
  EXPECT_FALSE(passes("localhost:8080", "https://localhost:8080"));
  EXPECT_FALSE(passes("localhost:8080", "null"));
  EXPECT_FALSE(passes("localhost:8080", ""));
}

TEST(Access, SaysWhichHeader) {
  EXPECT_EQ(kAccess.check("x", {}).error().field, "Host");
  EXPECT_EQ(kAccess.check("localhost:8080", "x").error().field, "Origin");
}

TEST(Access, ANameGivenWithoutAPortHasAnyPort) {
  const Access access({"127.0.0.1", 8080}, {"maps.example", "[fd00::1]", "other.example:9000"});
  EXPECT_TRUE(access.check("maps.example:8080", "http://maps.example:8080"));
  EXPECT_TRUE(access.check("maps.example", {}));
  EXPECT_TRUE(access.check("[fd00::1]:80", {}));
  EXPECT_TRUE(access.check("[fd00::1]", {}));
  EXPECT_TRUE(access.check("other.example:9000", {}));
  EXPECT_FALSE(access.check("other.example:9001", {}));
  EXPECT_FALSE(access.check("maps.example:80:80", {}));
  EXPECT_FALSE(access.check("localhost:9000", {}));
}

TEST(Access, OnPortEightyTheNameAloneWill) {
  const Access access({"10.0.0.7", 80}, {});
  EXPECT_TRUE(access.check("10.0.0.7", {}));
  EXPECT_TRUE(access.check("localhost", "http://localhost"));
}

}  // namespace
}  // namespace earthwork::net
