// Peers that break the rules beneath the messages: each ends alone, and others notice nothing.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

// What a server says last, as WebSocket frames: a close with its reason (RFC 6455, 7.4.1).
const std::string kProtocolError("\x88\x02\x03\xEA", 4);

SessionLimits patient() {
  SessionLimits limits;
  limits.hello = limits.silence = limits.request = 60s;
  limits.farewell = 1s;
  return limits;
}

SessionLimits hasty() {
  SessionLimits limits = patient();
  limits.hello = limits.request = 500ms;
  return limits;
}

struct HostileTest : testing::Test {
  explicit HostileTest(const SessionLimits& limits = patient()) {
    server =
        Server::start({.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = limits}).value();
    port = server->address().port;
  }
  ~HostileTest() override { EXPECT_EQ(http_get(port, "/healthz").body, "ok\n"); }

  std::string handshake() const { return handshake_text(server->address().text()); }
  /// What the server says before it closes, which it must.
  static std::string last_words(TcpClient& client) {
    bool closed = false;
    std::string words = client.read_to_end(closed);
    EXPECT_TRUE(closed);
    return words;
  }
  /// Opens a WebSocket, sends `bytes` on it, and gives back what the server says before it closes.
  std::string answer_to(const std::string& bytes) const {
    TcpClient client(port);
    EXPECT_TRUE(client.send(handshake()));
    EXPECT_TRUE(client.read_head().starts_with("HTTP/1.1 101"));
    client.send(bytes);
    return last_words(client);
  }

  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

TEST_F(HostileTest, AnUnmaskedFrame) { EXPECT_EQ(answer_to("\x81\x02{}"), kProtocolError); }

TEST_F(HostileTest, AReservedOpcode) {
  EXPECT_EQ(answer_to(std::string("\x83\x80\0\0\0\0", 6)), kProtocolError);
}

TEST_F(HostileTest, ACompressedFrameNobodyAgreedTo) {
  EXPECT_EQ(answer_to(std::string("\xC1\x80\0\0\0\0", 6)), kProtocolError);
}

TEST_F(HostileTest, AFrameThatClaimsExabytes) {
  const std::string claim("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14);
  // It comes in part: far more than a message may have.
  EXPECT_NE(answer_to(claim + std::string(70'000, 'x')).find("too_large"), std::string::npos);
}

TEST_F(HostileTest, WrongUtf8) {
  SocketClient client(port);
  client.text("\"\xFF\xFE\"");
  EXPECT_EQ(client.receive().kind, SocketClient::Kind::closed);
}

TEST_F(HostileTest, FramesBeforeTheHandshakeIsThrough) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake() + "\x81\x82\x01\x01\x01\x01zz"));
  EXPECT_EQ(last_words(client), "");
}

TEST_F(HostileTest, AHandshakeWithoutAKey) {
  const HttpAnswer answer =
      http(port, "GET /ws HTTP/1.1\r\nHost: " + server->address().text() +
                     "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                     "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: earthwork.v1\r\n\r\n");
  EXPECT_GE(answer.status, 400);
}

TEST_F(HostileTest, AnUpgradeElsewhere) {
  std::string elsewhere = handshake();
  elsewhere.replace(elsewhere.find("/ws"), 3, "/wx");
  EXPECT_EQ(http(port, elsewhere).status, 404);
}

struct HastyHostileTest : HostileTest {
  HastyHostileTest() : HostileTest(hasty()) {}
};

TEST_F(HastyHostileTest, AHandshakeThatNeverEnds) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake().substr(0, 60)));
  EXPECT_EQ(last_words(client), "");
}

TEST_F(HastyHostileTest, AMessageThatNeverEnds) {
  // A first fragment, and no more.
  EXPECT_NE(answer_to(std::string("\x01\x81\0\0\0\0x", 7)).find("timeout"), std::string::npos);
}

}  // namespace
}  // namespace earthwork::net
