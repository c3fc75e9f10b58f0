// Sessions over real sockets: painting, watching, and how they end.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <future>
#include <map>
#include <optional>
#include <thread>
#include <variant>

#include "protocol/frame.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

const std::string kHello = R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})";
const std::string kJoin = R"({"type":"join","map":"m","id":2})";
const std::string kViewAll = R"({"type":"view","n":1,"all":true,"id":3})";

std::string edit(int id, double x, double y, double radius) {
  return R"({"type":"edit","id":)" + std::to_string(id) +
         R"(,"stencil":"circle","fill":true,"x":)" + std::to_string(x) + R"(,"y":)" +
         std::to_string(y) + R"(,"radius":)" + std::to_string(radius) + "}";
}

struct SessionTest : testing::Test {
  explicit SessionTest(SessionLimits limits = {}) {
    server =
        Server::start({.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = limits}).value();
    port = server->address().port;
    EXPECT_TRUE(room::create_map(server->atlas(), "m", {.chunk_resolution = 8, .chunks = {}}));
  }

  /// The next text as a message.
  static protocol::ServerMessage hear(SocketClient& client) {
    const std::string text = client.receive_text();
    const auto message = protocol::parse_server_message(text);
    if (!message) throw std::runtime_error("not a message: '" + text + "'");
    return *message;
  }
  template <class T>
  static T hear_a(SocketClient& client) {
    return std::get<T>(hear(client));
  }
  /// Through hello and join.
  std::unique_ptr<SocketClient> guest() {
    auto client = std::make_unique<SocketClient>(port);
    client->text(kHello), hear_a<protocol::Welcome>(*client);
    client->text(kJoin), hear_a<protocol::Joined>(*client);
    return client;
  }
  /// Says bye with `code`, and closes.
  static void expect_bye(SocketClient& client, Code code) {
    EXPECT_EQ(hear_a<protocol::Bye>(client).failure.code, code);
    EXPECT_EQ(client.receive().kind, SocketClient::Kind::closed);
  }

  /// In the room.
  [[nodiscard]] std::size_t users() const {
    const auto room = room::find_map(server->atlas(), "m");
    std::promise<std::size_t> count;
    room->strand().post([&] { count.set_value(room->info().users); });
    return count.get_future().get();
  }

  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

/// Reads a client's messages until one says that the map is at `seq`: the mesh hash then.
std::uint64_t watch_until(SocketClient& client, std::uint64_t seq) {
  std::map<protocol::ChunkKey, protocol::ChunkRecord> chunks;
  protocol::FrameReader reader;
  for (std::uint64_t at = 0; at < seq;) {
    const auto received = client.receive();
    if (received.kind == SocketClient::Kind::text) {
      const auto message = protocol::parse_server_message(received.bytes).value();
      if (const auto* said = std::get_if<protocol::CaughtUp>(&message)) at = said->seq;
      continue;
    }
    if (received.kind != SocketClient::Kind::binary) throw std::runtime_error("the session ended");
    std::vector<protocol::FrameEvent> events;
    if (!reader.feed(std::as_bytes(std::span(received.bytes)), events))
      throw std::runtime_error("a bad frame");
    for (const auto& event : events) {
      if (const auto* end = std::get_if<protocol::GroupEnd>(&event)) at = end->seq;
      if (const auto* record = std::get_if<protocol::ChunkRecord>(&event))
        chunks[record->key] = *record;
      if (const auto* delta = std::get_if<protocol::ChunkDelta>(&event))
        chunks[delta->key] = protocol::apply_delta(chunks.at(delta->key).mesh, *delta).value();
    }
  }
  std::uint64_t sum = 0;
  for (const auto& [key, record] : chunks)
    if (!record.removed) sum += protocol::mesh_hash_term(key, protocol::mesh_hash(record.mesh));
  return sum;
}

TEST_F(SessionTest, OpensWithItsSubprotocolOnly) {
  SocketClient client(port);
  EXPECT_EQ(client.status(), 101);
  EXPECT_EQ(client.subprotocol(), "earthwork.v1");
  EXPECT_EQ(SocketClient(port, {.subprotocol = "x, earthwork.v1"}).status(), 101);
  EXPECT_EQ(SocketClient(port, {.subprotocol = "earthwork.v2"}).status(), 400);
  EXPECT_EQ(SocketClient(port, {.subprotocol = ""}).status(), 400);
}

TEST_F(SessionTest, OpensUnderItsNameOnly) {
  EXPECT_EQ(SocketClient(port, {.host = "evil.example"}).status(), 403);
  EXPECT_EQ(SocketClient(port, {.origin = "http://evil.example"}).status(), 403);
  EXPECT_EQ(SocketClient(port, {.origin = server->url()}).status(), 101);
}

TEST_F(SessionTest, PaintsAndShows) {
  const auto client = guest();
  client->text(edit(3, 8, 8, 5));
  EXPECT_EQ(hear_a<protocol::Applied>(*client), (protocol::Applied{3, 1}));
  client->text(kViewAll);
  EXPECT_EQ(hear_a<protocol::Done>(*client).id, 3);
  EXPECT_EQ(hear_a<protocol::CaughtUp>(*client), (protocol::CaughtUp{1, 1}));
}

TEST_F(SessionTest, EveryViewerEndsWithTheMeshOfTheServer) {
  const auto painter = guest(), a = guest(), b = guest();
  a->text(kViewAll), b->text(kViewAll);
  constexpr int kEdits = 300;
  std::thread painting([&] {
    for (int i = 1; i <= kEdits; ++i)
      painter->text(edit(i + 10, 40 + 30 * std::cos(i), 40 + 30 * std::sin(i), 2 + i % 5));
    for (int i = 1; i <= kEdits; ++i)
      EXPECT_EQ(hear_a<protocol::Applied>(*painter),
                (protocol::Applied{i + 10, static_cast<std::uint64_t>(i)}));
  });
  const std::uint64_t seen_a = watch_until(*a, kEdits);
  const std::uint64_t seen_b = watch_until(*b, kEdits);
  painting.join();
  EXPECT_EQ(seen_a, seen_b);
  const std::string figures = http_get(port, "/api/maps/m/figures").body;
  EXPECT_NE(figures.find("\"mesh_hash\":\"" + protocol::hex(seen_a)), std::string::npos) << figures;
}

TEST_F(SessionTest, AnswersWhatCannotBeReadAndGoesOn) {
  const auto client = guest();
  client->text("{nonsense");
  EXPECT_EQ(hear_a<protocol::Rejected>(*client).failure.code, Code::bad_json);
  client->text(std::string(3000, '['));
  EXPECT_EQ(hear_a<protocol::Rejected>(*client).failure.code, Code::bad_json);
  client->text(
      R"({"type":"edit","id":5,"stencil":"circle","fill":true,"x":1e999,"y":0,"radius":1})");
  EXPECT_EQ(hear_a<protocol::Rejected>(*client).id, 5);
  client->binary("\x01\x02");
  EXPECT_EQ(hear_a<protocol::Rejected>(*client).failure.code, Code::bad_message);
  client->text(R"({"type":"ping","id":6})");
  EXPECT_EQ(hear_a<protocol::Done>(*client).id, 6);
}

TEST_F(SessionTest, AMessageMayHaveSoMuchAndNotAByteMore) {
  const auto padded = [](std::size_t bytes) {
    std::string message = R"({"type":"ping","id":9,"note":")";
    message.append(bytes - message.size() - 2, 'x');
    return message + "\"}";
  };
  const auto client = guest();
  client->text(padded(protocol::kMaxControlBytes));
  EXPECT_EQ(hear_a<protocol::Done>(*client).id, 9);
  client->text(padded(protocol::kMaxControlBytes + 1));
  expect_bye(*client, Code::too_large);
}

TEST_F(SessionTest, SaysByeWhenTheMapIsDeleted) {
  const auto client = guest();
  room::erase_map(server->atlas(), "m");
  expect_bye(*client, Code::unknown_map);
}

TEST_F(SessionTest, SaysByeWhenTheServerEnds) {
  const auto a = guest(), b = guest();
  SocketClient silent(port);  // has not even said hello
  std::thread ending([this] { server->stop(); });
  expect_bye(*a, Code::shutting_down);
  expect_bye(*b, Code::shutting_down);
  expect_bye(silent, Code::shutting_down);
  ending.join();
}

TEST_F(SessionTest, EndsInTimeAlsoWithSomebodyWhoDoesNotRead) {
  const auto stuck = guest();
  const auto start = std::chrono::steady_clock::now();
  server->stop();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 15s);
}

TEST_F(SessionTest, WhoLeavesWithoutAWordIsGone) {
  { const auto client = guest(); }
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (users() > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(10ms);
  EXPECT_EQ(users(), 0u);
}

SessionLimits limits_of(std::chrono::milliseconds hello, std::chrono::milliseconds silence) {
  SessionLimits limits;
  limits.hello = hello;
  limits.silence = silence;
  limits.farewell = 1s;
  return limits;
}

struct ImpatientTest : SessionTest {
  ImpatientTest() : SessionTest(limits_of(500ms, 60s)) {}
};

constexpr auto kSilence = 2s;

struct SilenceTest : SessionTest {
  SilenceTest() : SessionTest(limits_of(60s, kSilence)) {}
};

TEST_F(ImpatientTest, WithoutAHelloItEnds) {
  SocketClient client(port);
  expect_bye(client, Code::timeout);
}

TEST_F(ImpatientTest, OtherMessagesAreNoHello) {
  SocketClient client(port);
  client.text(R"({"type":"ping","id":1})");
  EXPECT_EQ(hear_a<protocol::Rejected>(client).id, 1);
  expect_bye(client, Code::timeout);
}

TEST_F(SilenceTest, WhoAnswersPingsMayBeSilent) {
  const auto client = guest();
  // Reading answers the server's pings; nothing else is said.
  EXPECT_EQ(client->receive(5s).kind, SocketClient::Kind::nothing);
}

TEST_F(SilenceTest, WhoIsSilentAndAnswersNothingIsGone) {
  TcpClient client(port);  // it reads, but knows no pings
  ASSERT_TRUE(client.send(handshake_text(server->address().text())));
  EXPECT_TRUE(client.read_head().starts_with("HTTP/1.1 101"));
  const auto start = std::chrono::steady_clock::now();
  ASSERT_TRUE(client.send(masked_text(kHello)));
  bool closed = false;
  const std::string words = client.read_to_end(closed);
  EXPECT_TRUE(closed);
  EXPECT_NE(words.find("\"welcome\""), std::string::npos);
  EXPECT_NE(words.find("\"timeout\""), std::string::npos);
  EXPECT_GE(std::chrono::steady_clock::now() - start, kSilence);
}

TEST_F(SilenceTest, WhoDoesNotReadIsGone) {
  const auto stuck = guest();
  stuck->text(kViewAll);
  const auto painter = guest();
  // More than any socket buffer holds, so that the writer is stuck in the middle of a message.
  for (int i = 1; i <= 400; ++i) {
    painter->text(edit(i, 200 + 150 * std::cos(i), 200 + 150 * std::sin(i), 40 + i % 7));
    hear_a<protocol::Applied>(*painter);
  }
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (users() > 1 && std::chrono::steady_clock::now() < deadline) {
    painter->text(R"({"type":"ping","id":1})"), hear_a<protocol::Done>(*painter);
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(users(), 1u);
}

}  // namespace
}  // namespace earthwork::net
