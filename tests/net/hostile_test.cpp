// Peers that break the rules beneath the messages: each ends alone, and others notice nothing.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

struct HostileTest : testing::Test {
  HostileTest() {
    ServerOptions options{.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = {}};
    options.limits.hello = 500ms;
    options.limits.request = 500ms;
    options.limits.farewell = 300ms;
    server = Server::start(options).value();
    port = server->address().port;
  }
  ~HostileTest() override { EXPECT_EQ(http_get(port, "/healthz").body, "ok\n"); }

  std::string handshake() const { return handshake_text(server->address().text()); }
  /// What the server says before it closes, which it must.
  static std::string last_words(TcpClient& client) {
    bool closed = false;
    std::string words = client.read_to_end(5s, closed);
    EXPECT_TRUE(closed);
    return words;
  }

  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

TEST_F(HostileTest, AnUnmaskedFrame) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake()));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(client.send("\x81\x02{}"));
  EXPECT_TRUE(last_words(client).starts_with("HTTP/1.1 101"));
}

TEST_F(HostileTest, AReservedOpcode) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake()));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(client.send(std::string("\x83\x80\0\0\0\0", 6)));
  last_words(client);
}

TEST_F(HostileTest, ACompressedFrameNobodyAgreedTo) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake()));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(client.send(std::string("\xC1\x80\0\0\0\0", 6)));
  last_words(client);
}

TEST_F(HostileTest, AFrameThatClaimsExabytes) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake()));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(client.send(std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14)));
  // It comes in part: far more than a message may have.
  const std::string flood(70'000, 'x');
  client.send(flood);
  EXPECT_NE(last_words(client).find("too_large"), std::string::npos);
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

TEST_F(HostileTest, AHandshakeThatNeverEnds) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake().substr(0, 60)));
  last_words(client);
}

TEST_F(HostileTest, AHandshakeWithoutAKey) {
  const HttpAnswer answer =
      http(port, "GET /ws HTTP/1.1\r\nHost: " + server->address().text() +
                     "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                     "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: earthwork.v1\r\n\r\n");
  EXPECT_GE(answer.status, 400);
}

TEST_F(HostileTest, AMessageThatNeverEnds) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake()));
  std::this_thread::sleep_for(50ms);
  ASSERT_TRUE(client.send(std::string("\x01\x81\0\0\0\0x", 7)));  // a first fragment, and no more
  EXPECT_NE(last_words(client).find("timeout"), std::string::npos);
}

TEST_F(HostileTest, AnUpgradeElsewhere) {
  std::string elsewhere = handshake();
  elsewhere.replace(elsewhere.find("/ws"), 3, "/wx");
  EXPECT_EQ(http(port, elsewhere).status, 404);
}

}  // namespace
}  // namespace earthwork::net
