// The socket: messages whole and in order both ways, and how a connection can end.
#include "client/link/web_socket.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <vector>

#include "protocol/limits.hpp"
#include "tests/link/fake_server.hpp"

namespace earthwork::link {
namespace {

/// Runs a socket until it has closed, and keeps what it received.
struct Client {
  explicit Client(const ServerAddress& server, std::function<void(Client&)> opened = {},
                  SocketOptions options = {})
      : then(std::move(opened)),
        socket(loop, server,
               {.opened =
                    [this] {
                      was_open = true;
                      if (then) then(*this);
                    },
                .text = [this](std::string_view text) { take(std::string(text)); },
                .binary =
                    [this](std::span<const std::byte> bytes) {
                      take("binary " +
                           std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
                    },
                .closed =
                    [this](SocketEnd how, const std::string& reason) {
                      end = how;
                      why = reason;
                    }},
               options) {
    loop.run();
  }
  void take(std::string message) {
    received.push_back(std::move(message));
    if (received.size() == close_after) socket.close();
  }

  EventLoop loop;
  std::vector<std::string> received;
  std::size_t close_after = 0;
  bool was_open = false;
  std::optional<SocketEnd> end;
  std::string why;
  std::function<void(Client&)> then;
  WebSocket socket;
};

/// Sends back what comes until the client closes.
void echo(Peer& peer) {
  for (std::string text = peer.read(); !text.starts_with("closed"); text = peer.read()) {
    if (text.starts_with("binary "))
      peer.write_binary(text.substr(7));
    else
      peer.write(text);
  }
}

TEST(WebSocket, CarriesTextAndBinaryBothWaysInOrder) {
  const FakeServer server("earthwork.v1", echo);
  const Client client(server.address(), [](Client& c) {
    c.close_after = 3;
    c.socket.write_text("one");
    c.socket.write_binary(std::string("\0\1\2", 3));
    c.socket.write_text("three");
  });
  EXPECT_EQ(client.received,
            (std::vector<std::string>{"one", std::string("binary \0\1\2", 10), "three"}));
  EXPECT_EQ(client.end, SocketEnd::closed);
  EXPECT_EQ(client.why, "");
}

TEST(WebSocket, HandsNothingOnWhileItIsPaused) {
  constexpr std::size_t kMessages = 2000;
  const std::string message(16 * 1024, 'x');  // all together more than the buffers take
  std::atomic<std::size_t> written = 0;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    for (; written < kMessages; ++written) peer.write_binary(message);
    peer.read();
  });
  std::size_t written_early = 0, received_early = 1;
  std::optional<Timer> timer;
  const Client client(server.address(), [&](Client& c) {
    c.close_after = kMessages;
    c.socket.pause_reading(true);
    timer.emplace(c.loop);
    timer->start(std::chrono::milliseconds(100), [&] {
      written_early = written;
      received_early = c.received.size();
      c.socket.pause_reading(false);
      timer.reset();  // before its loop
    });
  });
  EXPECT_EQ(received_early, 0u);
  EXPECT_LT(written_early, kMessages);
  EXPECT_EQ(client.received.size(), kMessages);
  EXPECT_EQ(client.end, SocketEnd::closed);
}

TEST(WebSocket, ClosesWhileItIsPaused) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.write("unheard");
    EXPECT_EQ(peer.read(), "closed 1000");
  });
  const Client client(server.address(), [](Client& c) {
    c.socket.pause_reading(true);
    c.socket.close();
  });
  EXPECT_TRUE(client.received.empty());
  EXPECT_EQ(client.end, SocketEnd::closed);
}

TEST(WebSocket, ReadsThroughASmallBuffer) {
  const FakeServer server("earthwork.v1", echo);
  const Client client(server.address(),
                      [](Client& c) {
                        c.close_after = 4;
                        for (int i = 0; i < 4; ++i) c.socket.write_binary(std::string(16'000, 'y'));
                      },
                      {.receive_buffer_bytes = 4096});
  EXPECT_EQ(client.received, std::vector<std::string>(4, "binary " + std::string(16'000, 'y')));
}

TEST(WebSocket, WritesWhatIsQueuedBeforeItCloses) {
  std::vector<std::string> arrived;
  {
    const FakeServer server("earthwork.v1", [&](Peer& peer) {
      for (std::string text = peer.read(); arrived.emplace_back(text), !text.starts_with("closed");)
        text = peer.read();
    });
    const Client client(server.address(), [](Client& c) {
      c.socket.write_text("a");
      c.socket.write_text("b");
      EXPECT_EQ(c.socket.queued_bytes(), 2u);
      c.socket.close();
      c.socket.write_text("too late");
    });
    EXPECT_EQ(client.end, SocketEnd::closed);
  }
  EXPECT_EQ(arrived, (std::vector<std::string>{"a", "b", "closed 1000"}));
}

TEST(WebSocket, HandsNothingOnAfterItsClose) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    for (int i = 0; i < 3; ++i) peer.write("more");
    echo(peer);
  });
  const Client client(server.address(), [](Client& c) { c.socket.close(); });
  EXPECT_TRUE(client.received.empty());
  EXPECT_EQ(client.end, SocketEnd::closed);
}

TEST(WebSocket, EndsCleanlyWhenTheServerClosesNormally) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.write("last words");
    peer.close(1000);
  });
  const Client client(server.address());
  EXPECT_EQ(client.received, std::vector<std::string>{"last words"});
  EXPECT_EQ(client.end, SocketEnd::closed);
}

TEST(WebSocket, IsLostWhenTheServerClosesWithAnotherCode) {
  const FakeServer server("earthwork.v1", [](Peer& peer) { peer.close(1011); });
  const Client client(server.address());
  EXPECT_EQ(client.end, SocketEnd::lost);
  EXPECT_EQ(client.why, "it closed the connection with code 1011");
}

TEST(WebSocket, IsLostWhenTheServerDropsIt) {
  const FakeServer server("earthwork.v1", [](Peer&) {});
  const Client client(server.address());
  EXPECT_TRUE(client.was_open);
  EXPECT_EQ(client.end, SocketEnd::lost);
  EXPECT_NE(client.why, "");
}

TEST(WebSocket, CannotReachAPortWhereNobodyListens) {
  const Client client(nobody());
  EXPECT_FALSE(client.was_open);
  EXPECT_EQ(client.end, SocketEnd::unreachable);
  EXPECT_EQ(client.why, "Connection refused");
}

TEST(WebSocket, CannotReachAServerThatKnowsNoWebSockets) {
  const FakeServer server("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n");
  const Client client(server.address());
  EXPECT_EQ(client.end, SocketEnd::unreachable);
  EXPECT_EQ(client.why, "it answers 404 to a WebSocket");
}

TEST(WebSocket, InsistsOnItsSubprotocol) {
  const FakeServer server("", [](Peer& peer) { peer.read(); });
  const Client client(server.address());
  EXPECT_FALSE(client.was_open);
  EXPECT_EQ(client.end, SocketEnd::unreachable);
  EXPECT_EQ(client.why, "it does not speak earthwork.v1");
}

TEST(WebSocket, TakesMessagesUpToTheirLimits) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.write(std::string(protocol::kMaxServerControlBytes, 'x'));
    peer.write_binary(std::string(protocol::kMaxFrameBytes, 'x'));
    echo(peer);
  });
  const Client client(server.address(), [](Client& c) { c.close_after = 2; });
  ASSERT_EQ(client.received.size(), 2u);
  EXPECT_EQ(client.received[0].size(), 1048576u);
  EXPECT_EQ(client.received[1].size(), 7 + 16384u);
}

TEST(WebSocket, IsLostOnATextBeyondTheLimit) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.write(std::string(protocol::kMaxServerControlBytes + 1, 'x'));
    peer.read();
  });
  const Client client(server.address());
  EXPECT_TRUE(client.received.empty());
  EXPECT_EQ(client.end, SocketEnd::lost);
}

TEST(WebSocket, IsLostOnABinaryMessageBeyondTheLimit) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.write_binary(std::string(protocol::kMaxFrameBytes + 1, 'x'));
    peer.read();
  });
  const Client client(server.address());
  EXPECT_TRUE(client.received.empty());
  EXPECT_EQ(client.end, SocketEnd::lost);
  EXPECT_EQ(client.why, "a binary message is longer than 16384 bytes");
}

TEST(WebSocket, ClosesBeforeItIsOpen) {
  const FakeServer server("earthwork.v1", echo);
  EventLoop loop;
  std::optional<SocketEnd> end;
  WebSocket socket(loop, server.address(),
                   {.opened = [] { ADD_FAILURE() << "opened"; },
                    .text = {},
                    .binary = {},
                    .closed = [&](SocketEnd how, const std::string&) { end = how; }});
  socket.close();
  loop.run();
  EXPECT_EQ(end, SocketEnd::closed);
}

TEST(WebSocket, MayBeDestroyedByItsHandler) {
  const FakeServer server("earthwork.v1", echo);
  EventLoop loop;
  std::optional<WebSocket> socket;
  int calls = 0;
  SocketHandlers handlers;
  handlers.opened = [&] { socket->write_text("hello"); };
  handlers.text = [&](std::string_view) { ++calls, socket.reset(); };
  handlers.closed = [&](SocketEnd, const std::string&) { ADD_FAILURE() << "closed"; };
  socket.emplace(loop, server.address(), handlers);
  loop.run();
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace earthwork::link
