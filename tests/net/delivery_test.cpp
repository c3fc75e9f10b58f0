// How a session's bytes leave: whole and in order, what is urgent first, and nobody waits for a
// viewer that does not read. Over real sockets, whose buffers the meshes overflow many times.
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"
#include "tests/net/wire_messages.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;

const std::string kHello = R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})";
const std::string kJoin = R"({"type":"join","map":"m","id":2})";
const std::string kViewAll = R"({"type":"view","n":1,"all":true,"id":3})";
// A ping and a close from a client, under masks of zeros.
const std::string kAreYouThere = "are you there, 4711";
const std::string kClose("\x88\x80\0\0\0\0", 6);

// The answer to it: close, for code 1000.
const std::string kClosed = "\x88\x02\x03\xe8";

// The meshes of the map, at the least; and what may lie between a session and a client that does
// not read, at the most: what the session took, and the kernel's buffers at both ends.
constexpr std::size_t kMapBytes = 3'000'000, kOnTheWayBytes = 1'500'000;

std::string ping_frame(const std::string& payload) {
  std::string frame = "\x89";
  frame += static_cast<char>(0x80 | payload.size());
  return frame.append(4, '\0').append(payload);
}

/// 32 x 32 dots, of which each chunk of 8 voxels has a few.
std::string edit_of_dots(int id, int column) {
  std::string edit = R"({"type":"edit","id":)" + std::to_string(id) +
                     R"(,"stencil":"circle","fill":true,"radius":1.3,"path":[)";
  for (int i = 0; i < 1024; ++i)
    edit += (i > 0 ? ",[" : "[") + std::to_string(5 * (i / 32) + 160 * column) + "," +
            std::to_string(5 * (i % 32)) + "]";
  return edit + "]}";
}

struct DeliveryTest : testing::Test {
  DeliveryTest() {
    SessionLimits limits;
    limits.hello = limits.silence = limits.farewell = 2min;
    server =
        Server::start({.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = limits}).value();
    EXPECT_TRUE(room::create_map(server->atlas(), "m", {.chunk_resolution = 8, .chunks = {}}));
  }

  /// Through hello and join.
  std::unique_ptr<SocketClient> guest() {
    auto client = std::make_unique<SocketClient>(server->address().port);
    client->text(kHello), client->receive_text();
    client->text(kJoin), client->receive_text();
    return client;
  }
  /// A guest that does not read unless it is told to.
  std::unique_ptr<TcpClient> raw_guest() {
    auto client = std::make_unique<TcpClient>(server->address().port);
    client->send(handshake_text(server->address().text()));
    EXPECT_TRUE(client->read_head().starts_with("HTTP/1.1 101"));
    client->send(masked_text(kHello) + masked_text(kJoin));
    client->read_until("\"joined\"");
    return client;
  }
  void paint_dots() {
    const auto painter = guest();
    constexpr int kColumns = 24;
    for (int i = 0; i < kColumns; ++i) painter->text(edit_of_dots(10 + i, i));
    for (int i = 0; i < kColumns; ++i)
      EXPECT_NE(painter->receive_text().find("\"applied\""), std::string::npos);
  }
  /// What the room says when asked there.
  [[nodiscard]] std::uint64_t seq() const {
    const auto room = room::find_map(server->atlas(), "m");
    std::promise<std::uint64_t> seq;
    room->strand().post([&] { seq.set_value(room->info().seq); });
    return seq.get_future().get();
  }

  std::unique_ptr<Server> server;
};

bool says(const SocketClient::Received& received, std::string_view words) {
  return received.kind == SocketClient::Kind::text &&
         received.bytes.find(words) != std::string::npos;
}

TEST_F(DeliveryTest, ControlOvertakesMeshesThatWait) {
  paint_dots();
  const auto viewer = guest();
  viewer->text(kViewAll);
  // That the painter has left may be told before.
  auto answer = viewer->receive();
  while (says(answer, "\"presence\"")) answer = viewer->receive();
  ASSERT_TRUE(says(answer, "\"done\""));
  ASSERT_EQ(viewer->receive().kind, SocketClient::Kind::binary);
  // It reads no more, so the socket fills up. What it says then is heard and answered in order; the
  // edit can be seen to have come.
  const std::uint64_t before = seq();
  viewer->text(R"({"type":"ping","id":4})");
  viewer->text(R"({"type":"edit","id":5,"stencil":"circle","fill":true,"x":-50,"y":0,"radius":1})");
  while (seq() == before) std::this_thread::sleep_for(1ms);

  std::size_t before_answers = 0, all = 0;
  int answers = 0;
  for (auto received = viewer->receive(); !says(received, "\"caught_up\"");
       received = viewer->receive()) {
    ASSERT_TRUE(received.kind == SocketClient::Kind::binary ||
                received.kind == SocketClient::Kind::text);
    answers += says(received, R"("id":4)") || says(received, R"("id":5)");
    if (received.kind != SocketClient::Kind::binary) continue;
    all += received.bytes.size();
    if (answers < 2) before_answers += received.bytes.size();
  }
  EXPECT_EQ(answers, 2);
  EXPECT_GT(all, kMapBytes);
  EXPECT_LT(before_answers, kOnTheWayBytes);
}

TEST_F(DeliveryTest, APongComesInTheMiddleOfTheMeshes) {
  paint_dots();
  const auto viewer = raw_guest();
  viewer->send(masked_text(kViewAll));
  viewer->read_until("\"done\"");
  viewer->send(ping_frame(kAreYouThere));
  const std::string before = viewer->read_until(kAreYouThere);
  EXPECT_LT(before.size(), kOnTheWayBytes);
  const std::string head{before.end() - static_cast<std::ptrdiff_t>(kAreYouThere.size()) - 2,
                         before.end() - static_cast<std::ptrdiff_t>(kAreYouThere.size())};
  EXPECT_EQ(head, std::string("\x8a") + static_cast<char>(kAreYouThere.size()));

  // Nothing was cut by it: the rest is whole messages, and whole records across them.
  std::string rest = viewer->read_until("\"caught_up\"");
  EXPECT_GT(rest.size(), kMapBytes - kOnTheWayBytes);
}

TEST_F(DeliveryTest, WhoReadsLateGetsAllOfItWhole) {
  const auto viewer = raw_guest();
  viewer->send(masked_text(kViewAll));
  const std::string first = viewer->read_until("\"caught_up\"");
  paint_dots();  // nobody waits for the viewer
  viewer->send(masked_text(R"({"type":"edit","id":9,"stencil":"circle","fill":true,)"
                           R"("x":-50,"y":0,"radius":1})"));
  while (seq() < 25) std::this_thread::sleep_for(1ms);
  const std::string tail =
      viewer->read_until("\x82\x0a\x01\x03" + std::string("\x19\0\0\0\0\0\0\0", 8));

  // `first` ends inside a text message: the rest of it goes before the next message.
  const std::size_t start = tail.find('}') + 1;
  protocol::FrameReader reader;
  std::vector<protocol::FrameEvent> events;
  for (const WireMessage& message : wire_messages(std::string_view(tail).substr(start))) {
    if (message.kind == Kind::text)
      EXPECT_TRUE(protocol::parse_server_message(message.bytes)) << message.bytes;
    else
      ASSERT_TRUE(reader.feed(std::as_bytes(std::span(message.bytes)), events));
  }
  EXPECT_FALSE(reader.in_group());
  EXPECT_EQ(std::get<protocol::GroupEnd>(events.back()).seq, 25u);
}

TEST_F(DeliveryTest, MessagesAndBytesAreCounted) {
  const room::Meters& meters = server->atlas().meters();
  const auto viewer = guest();
  EXPECT_EQ(meters.sessions, 1);
  const std::uint64_t controls = meters.controls, control_bytes = meters.control_bytes;
  std::uint64_t texts = 0, text_bytes = 0, frames = 0, frame_bytes = 0;
  viewer->text(edit_of_dots(10, 0));
  viewer->text(kViewAll);
  for (bool last = false; !last;) {
    const auto received = viewer->receive();
    ASSERT_NE(received.kind, SocketClient::Kind::closed);
    last = says(received, "\"caught_up\"");
    const bool text = received.kind == SocketClient::Kind::text;
    (text ? texts : frames) += 1;
    (text ? text_bytes : frame_bytes) += received.bytes.size();
  }
  EXPECT_GE(texts, 3u);  // applied, done, caught_up
  EXPECT_GT(frames, 0u);
  EXPECT_EQ(meters.controls - controls, texts);
  EXPECT_EQ(meters.control_bytes - control_bytes, text_bytes);
  EXPECT_EQ(meters.frames, frames);
  EXPECT_EQ(meters.frame_bytes, frame_bytes);
}

TEST_F(DeliveryTest, WhoSaysCloseIsAnsweredAndGone) {
  auto viewer = raw_guest();
  viewer->send(kClose);
  bool closed = false;
  const std::string last = viewer->read_to_end(closed);
  EXPECT_TRUE(closed);
  EXPECT_TRUE(last.ends_with(kClosed)) << last.size();
  viewer.reset();
  while (server->atlas().meters().sessions > 0) std::this_thread::sleep_for(1ms);
}

TEST_F(DeliveryTest, ACloseIsAnsweredBehindWhatWasOnItsWay) {
  paint_dots();
  const auto viewer = raw_guest();
  viewer->send(masked_text(kViewAll));
  viewer->read_until("\"done\"");
  viewer->send(kClose);
  bool closed = false;
  const std::string rest = viewer->read_to_end(closed);
  EXPECT_TRUE(closed);
  EXPECT_LT(rest.size(), kOnTheWayBytes);
  EXPECT_TRUE(rest.ends_with(kClosed));
}

TEST_F(DeliveryTest, PingsOfWhoReadsSlowlyDoNoHarm) {
  paint_dots();
  const auto viewer = raw_guest();
  viewer->send(masked_text(kViewAll));
  viewer->read_until("\"done\"");
  // Each finds the socket full, and new meshes behind its answer.
  constexpr int kPings = 40;
  const std::string word = "are you there";
  std::string all;
  for (int i = 0; i < kPings; ++i) {
    ASSERT_TRUE(viewer->send(ping_frame(word + std::to_string(100 + i))));
    all += viewer->read_until(word + std::to_string(100 + i));
  }
  all += viewer->read_until("\"caught_up\"");
  EXPECT_GT(all.size(), kMapBytes - kOnTheWayBytes);
}

// Its session is not waited for, and goes with the server. The sanitizers look on.
TEST_F(DeliveryTest, AServerEndsBeforeASessionThatDoesNotAnswerItsGoodbye) {
  TcpClient client(server->address().port);
  client.send(handshake_text(server->address().text()));
  EXPECT_TRUE(client.read_head().starts_with("HTTP/1.1 101"));
  client.send(masked_text(kHello));
  client.read_until("\"welcome\"");
  server.reset();
  bool closed = false;
  EXPECT_NE(client.read_to_end(closed).find("\"bye\""), std::string::npos);
  EXPECT_TRUE(closed);
}

}  // namespace
}  // namespace earthwork::net
