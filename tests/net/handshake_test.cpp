// What a WebSocket's opening needs, header by header.
#include "server/net/handshake.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace earthwork::net {
namespace {

using nlohmann::json;

const Handshake kGood{
    .version = "13", .key = "dGhlIHNhbXBsZSBub25jZQ==", .offers_subprotocol = true};

void expect_refused(const Handshake& handshake, int status, const char* field) {
  const auto refused = refuse_handshake(handshake);
  ASSERT_TRUE(refused) << field;
  EXPECT_EQ(refused->status, status);
  EXPECT_EQ(refused->content_type, "application/problem+json");
  EXPECT_EQ(json::parse(refused->body).at("field"), field);
}

TEST(Handshake, ThatIsWholeMayGoOn) { EXPECT_FALSE(refuse_handshake(kGood)); }

TEST(Handshake, HasAKeyOfSixteenBytes) {
  Handshake bad = kGood;
  for (const char* key :
       {"", "x", "==", "AAAA==", "dGhlIHNhbXBsZSBub25jAZQ==", "dGhlIHNhbXBsZSBub25jZQ=",
        "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ===", "dGhlIHNhbXBsZSBub25jZQAA",
        "dGhlIHNhbXBsZSBub25j=Q==", "dGhlIHNhbXBsZSBub25-ZQ==", " GhlIHNhbXBsZSBub25jZQ==",
        "dGhlIHNhbXBsZSBub25jZQ==, dGhlIHNhbXBsZSBub25jZQ=="}) {
    bad.key = key;
    expect_refused(bad, 400, "Sec-WebSocket-Key");
  }
  bad.key.reset();
  expect_refused(bad, 400, "Sec-WebSocket-Key");
}

TEST(Handshake, IsOfTheVersionThatIsSpoken) {
  Handshake bad = kGood;
  for (const std::optional<std::string>& version :
       {std::optional<std::string>(), std::optional<std::string>("8"),
        std::optional<std::string>("13, 8"), std::optional<std::string>("")}) {
    bad.version = version;
    expect_refused(bad, 426, "Sec-WebSocket-Version");
    const auto headers = refuse_handshake(bad)->headers;
    ASSERT_EQ(headers.size(), 1u);
    EXPECT_EQ(headers[0].first, "Sec-WebSocket-Version");
    EXPECT_EQ(headers[0].second, "13");
  }
}

TEST(Handshake, OffersTheSubprotocol) {
  Handshake bad = kGood;
  bad.offers_subprotocol = false;
  expect_refused(bad, 400, "Sec-WebSocket-Protocol");
}

}  // namespace
}  // namespace earthwork::net
