// Peers that break the rules beneath the messages, or keep none of their own: each ends alone, with
// a clear answer, and somebody who paints on the same map meanwhile notices nothing.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "tests/net/hostile_server.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

// What a server says last, as WebSocket frames: a close with its reason (RFC 6455, 7.4.1).
const std::string kProtocolError("\x88\x02\x03\xEA", 4), kNotUtf8("\x88\x02\x03\xEF", 4);

struct HostilePeerTest : HostileTest {
  using HostileTest::HostileTest;

  std::string handshake() const { return handshake_text(server->address().text()); }
  /// What the server says before it closes, which it must.
  static std::string last_words(TcpClient& client) {
    bool closed = false;
    std::string words = client.read_to_end(closed);
    EXPECT_TRUE(closed);
    return words;
  }
  /// Opens a WebSocket on `client`; the head of the answer.
  std::string open(TcpClient& client) const {
    EXPECT_TRUE(client.send(handshake()));
    std::string head = client.read_head();
    EXPECT_TRUE(head.starts_with("HTTP/1.1 101")) << head;
    return head;
  }
  /// Opens a WebSocket, sends `bytes` on it, and gives back what the server says before it closes.
  std::string answer_to(const std::string& bytes) const {
    TcpClient client(port);
    open(client);
    client.send(bytes);
    return last_words(client);
  }
};

TEST_F(HostilePeerTest, AnUnmaskedFrame) { EXPECT_EQ(answer_to("\x81\x02{}"), kProtocolError); }

TEST_F(HostilePeerTest, AReservedOpcode) {
  EXPECT_EQ(answer_to(std::string("\x83\x80\0\0\0\0", 6)), kProtocolError);
}

TEST_F(HostilePeerTest, APingThatIsTooLong) {
  EXPECT_EQ(answer_to(std::string("\x89\xFE\x00\x7E\0\0\0\0", 8) + std::string(126, 'x')),
            kProtocolError);
}

TEST_F(HostilePeerTest, AFragmentOfNothing) {
  EXPECT_EQ(answer_to(std::string("\x80\x81\0\0\0\0x", 7)), kProtocolError);
}

TEST_F(HostilePeerTest, CompressionIsNotAgreedTo) {
  std::string offer = handshake();
  offer.insert(offer.size() - 2,
               "Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits\r\n");
  TcpClient client(port);
  ASSERT_TRUE(client.send(offer));
  const std::string head = client.read_head();
  EXPECT_TRUE(head.starts_with("HTTP/1.1 101")) << head;
  EXPECT_EQ(head.find("Extensions"), std::string::npos) << head;

  // Sixty megabytes of zeros, were it taken for compressed: the first of its bytes ends it.
  std::string bomb("\xC1\xFE\xEA\x60\0\0\0\0", 8);
  bomb += "\xEC\xC1\x31\x01" + std::string(60'000 - 4, '\0');
  client.send(bomb);
  EXPECT_EQ(last_words(client), kProtocolError);
}

TEST_F(HostilePeerTest, AFrameThatClaimsExabytes) {
  const std::string claim("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14);
  // It comes in part: far more than a message may have.
  const std::string answer = answer_to(claim + std::string(70'000, 'x'));
  EXPECT_NE(answer.find("too_large"), std::string::npos);
  EXPECT_NE(answer.find("65536"), std::string::npos);
}

TEST_F(HostilePeerTest, AMessageOfEndlesslyManyFragments) {
  std::string bytes("\x01\x81\0\0\0\0x", 7);
  for (int i = 0; i < 70'000; ++i) bytes += std::string_view("\x00\x81\0\0\0\0x", 7);
  EXPECT_NE(answer_to(bytes).find("too_large"), std::string::npos);
}

TEST_F(HostilePeerTest, WrongUtf8) {
  for (const char* wrong :
       {"\xFF\xFE", "\x80", "\xC0\xAF", "\xC3", "\xE0\x80\x80", "\xE2\x82", "\xED\xA0\x80",
        "\xED\xBF\xBF", "\xF0\x80\x80\x80", "\xF0\x9F\x98", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80"})
    EXPECT_EQ(answer_to(masked_text(std::string("\"") + wrong)), kNotUtf8)
        << testing::PrintToString(wrong);
}

TEST_F(HostilePeerTest, ACharacterMayBeCutByAFragment) {
  TcpClient client(port);
  open(client);
  std::string first = masked_text("{\"type\":\"hello\",\"protocol\":[1,1],\"name\":\"\xC3");
  first[0] = '\x01';
  std::string last = masked_text("\xA4\"}");
  last[0] = '\x80';
  ASSERT_TRUE(client.send(first + last));
  EXPECT_TRUE(client.read_until("\"welcome\"").ends_with("\"welcome\""));
}

TEST_F(HostilePeerTest, FramesBeforeTheHandshakeIsThrough) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake() + "\x81\x82\x01\x01\x01\x01zz"));
  EXPECT_EQ(last_words(client), "");
}

TEST_F(HostilePeerTest, AHandshakeByteByByte) {
  TcpClient client(port);
  for (const char byte : handshake()) ASSERT_TRUE(client.send({&byte, 1}));
  EXPECT_TRUE(client.read_head().starts_with("HTTP/1.1 101"));
  for (const char byte : masked_text(R"({"type":"ping","id":7})"))
    ASSERT_TRUE(client.send({&byte, 1}));
  EXPECT_TRUE(client.read_until(R"("id":7)").ends_with(R"("id":7)"));
}

/// The socket of this process that is connected to the port: the server's end.
std::optional<int> find_socket(std::uint16_t peer_port) {
  for (int fd = 0; fd < 65536; ++fd) {
    sockaddr_in peer{};
    socklen_t size = sizeof peer;
    if (getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &size) != 0) continue;
    if (peer.sin_family == AF_INET && ntohs(peer.sin_port) == peer_port) return fd;
  }
  return std::nullopt;
}

// A peer whose machine is gone acknowledges nothing, and cannot be made of a loopback: what ends it
// is the kernel, so here is what the kernel was asked for.
TEST_F(HostilePeerTest, WhoseMachineIsGoneTheKernelEndsAfterTheTimeOfSilence) {
  TcpClient client(port);
  open(client);
  const auto socket = find_socket(client.own_port());
  ASSERT_TRUE(socket);
  int timeout_ms = 0;
  socklen_t size = sizeof timeout_ms;
  ASSERT_EQ(getsockopt(*socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &timeout_ms, &size), 0);
  EXPECT_EQ(timeout_ms, 120'000);
}

SessionLimits hasty() {
  SessionLimits limits = patient();
  limits.hello = limits.request = 500ms;
  return limits;
}

struct HastyHostilePeerTest : HostilePeerTest {
  HastyHostilePeerTest() : HostilePeerTest(hasty()) {}
};

TEST_F(HastyHostilePeerTest, AHandshakeThatNeverEnds) {
  TcpClient client(port);
  ASSERT_TRUE(client.send(handshake().substr(0, 60)));
  EXPECT_EQ(last_words(client), "");
}

TEST_F(HastyHostilePeerTest, AMessageThatNeverEnds) {
  // A first fragment, and no more.
  EXPECT_NE(answer_to(std::string("\x01\x81\0\0\0\0x", 7)).find("timeout"), std::string::npos);
}

SessionLimits listening() {
  SessionLimits limits = patient();
  limits.silence = 2s;
  return limits;
}

struct SilentHostilePeerTest : HostilePeerTest {
  SilentHostilePeerTest() : HostilePeerTest(listening()) {}
};

// The socket stays open and its kernel takes every byte: only its own words are missing.
TEST_F(SilentHostilePeerTest, IsToldAndEnded) {
  TcpClient client(port);
  open(client);
  ASSERT_TRUE(client.send(masked_text(R"({"type":"hello","protocol":[1,1],"name":"x"})")));
  ASSERT_TRUE(client.send(masked_text(R"({"type":"join","map":"m"})")));
  const std::string words = last_words(client);
  EXPECT_NE(words.find("\"joined\""), std::string::npos) << words;
  EXPECT_NE(words.find("\"timeout\""), std::string::npos) << words;
}

SessionLimits crowded() {
  SessionLimits limits = patient();
  limits.connections = 3;  // the painter's, and two more
  return limits;
}

struct CrowdedTest : HostilePeerTest {
  CrowdedTest() : HostilePeerTest(crowded()) {}
};

TEST_F(CrowdedTest, WhoComesNextIsToldToComeBackLater) {
  {
    SocketClient one(port), two(port);
    ASSERT_EQ(one.status(), 101);
    ASSERT_EQ(two.status(), 101);
    EXPECT_EQ(SocketClient(port).status(), 503);
    const HttpAnswer refused = http_get(port, "/healthz");
    EXPECT_EQ(refused.status, 503);
    EXPECT_EQ(refused.headers.at("content-type"), "application/problem+json");
    EXPECT_EQ(refused.headers.at("retry-after"), "5");
    EXPECT_NE(refused.body.find("connections: the server has 3, its most"), std::string::npos)
        << refused.body;
    one.text(R"({"type":"hello","protocol":[1,1],"name":"x"})");
    EXPECT_NE(one.receive_text().find("welcome"), std::string::npos);
  }
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (http_get(port, "/healthz").status == 503 && std::chrono::steady_clock::now() < deadline) {
  }
}

}  // namespace
}  // namespace earthwork::net
