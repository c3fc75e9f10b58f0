// What a crowd of peers costs that claim much and send little: memory by the connection, and none
// for the claims; all of it is given back.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/net/hostile_server.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

constexpr int kPeers = 250;
// Far below the 64 KiB that a message or a body may have.
constexpr std::size_t kMaxBytesPerPeer = 32 * 1024;
// For the painter's edits, which the map keeps, and for what Asio keeps for the next ones.
constexpr std::size_t kMaxBytesKept = 3 * 1024 * 1024;

/// Bytes on the heap that are in use, by all threads of this process: the server's, and the little
/// that the painter's client takes.
std::size_t bytes_in_use() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// A plain socket: peers by the hundred would take too much of this process otherwise.
class Peer {
 public:
  explicit Peer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    const timeval patience{.tv_sec = 60, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  Peer(Peer&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  ~Peer() {
    if (socket_ >= 0) close(socket_);
  }

  void send(const std::string& bytes) {
    EXPECT_EQ(::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// Reads until `text` came.
  void expect(const std::string& text) {
    std::string read;
    std::array<char, 4096> piece{};
    while (read.find(text) == std::string::npos) {
      const ssize_t size = recv(socket_, piece.data(), piece.size(), 0);
      ASSERT_GT(size, 0) << "got " << read;
      read.append(piece.data(), static_cast<std::size_t>(size));
    }
  }

 private:
  int socket_;
};

struct HostileMemoryTest : HostileTest {
  /// What a crowd may cost while it is there, and afterwards. Each peer says `words`, and hears
  /// `answer` before it goes on: then the server has read them.
  void expect_cheap(const std::vector<std::pair<std::string, std::string>>& dialogue) {
    const std::size_t before = bytes_in_use();
    {
      std::vector<Peer> peers;
      for (int i = 0; i < kPeers; ++i) {
        peers.emplace_back(port);
        for (const auto& [words, answer] : dialogue) {
          peers.back().send(words);
          peers.back().expect(answer);
        }
      }
      EXPECT_TRUE(painter->is_answered());
      const std::size_t during = bytes_in_use();
      EXPECT_LT(during, before + kPeers * kMaxBytesPerPeer + kMaxBytesKept);
      RecordProperty("bytes_per_peer", static_cast<int>((during - before) / kPeers));
    }
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (bytes_in_use() > before + kMaxBytesKept && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(10ms);
    EXPECT_LT(bytes_in_use(), before + kMaxBytesKept);
  }

  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's heap counts otherwise";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
    GTEST_SKIP() << "a sanitizer's heap counts otherwise";
#endif
#endif
  }

  std::string host = "Host: " + server->address().text() + "\r\n";
  std::string open = handshake_text(server->address().text());
};

TEST_F(HostileMemoryTest, AFrameThatClaimsExabytesTakesNone) {
  const std::string ping("\x89\x80\0\0\0\0", 6), pong("\x8A\x00", 2);
  const std::string claim("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\0\0\0", 14);
  expect_cheap({{open, "\r\n\r\n"}, {ping + claim, pong}});
}

TEST_F(HostileMemoryTest, ABodyThatIsPromisedTakesNone) {
  expect_cheap({{"POST /api/maps HTTP/1.1\r\n" + host +
                     "Expect: 100-continue\r\nContent-Length: 65536\r\n\r\n{",
                 "100 Continue\r\n\r\n"}});
}

TEST_F(HostileMemoryTest, ASessionThatViewsEverythingAndReadsNothing) {
  expect_cheap({{open, "\r\n\r\n"},
                {masked_text(R"({"type":"hello","protocol":[1,1],"name":"x"})"), "\"welcome\""},
                {masked_text(R"({"type":"join","map":"m"})"), "\"joined\""},
                {masked_text(R"({"type":"view","n":1,"all":true,"id":9})"), "\"id\":9"}});
}

}  // namespace
}  // namespace earthwork::net
