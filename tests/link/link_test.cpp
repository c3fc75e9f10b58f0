// The link: hello, welcome, join, joined; then messages and frames; and every way to an end.
#include "client/link/link.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/limits.hpp"
#include "tests/link/fake_server.hpp"

namespace earthwork::link {
namespace {

using nlohmann::json;
using protocol::Code;

const std::string kWelcome =
    R"({"type":"welcome","session":"0123456789abcdef","key":"0123456789abcdef0123456789abcdef",)"
    R"("protocol":1,"limits":{}})";
const std::string kJoined =
    R"({"type":"joined","map":"demo","settings":{},"epoch":"00000000000000aa","seq":3,"users":[]})";

/// What a test has seen of a link that ran to its end.
struct Visit {
  explicit Visit(const ServerAddress& server, std::function<void(Visit&)> on_ready = {},
                 std::string map = "demo")
      : then(std::move(on_ready)) {
    protocol::Hello hello;
    hello.name = "tester";
    link.emplace(
        loop, LinkOptions{.server = server, .hello = hello, .map = std::move(map)},
        LinkHandlers{.ready = [this] { ready(); },
                     .message = [this](const auto& message) { take(message); },
                     .frame = [this](auto& events, std::size_t bytes) { take(events, bytes); },
                     .closed = [this](const Closing& c) { closing = c, ++closings; }});
    loop.run();
  }
  void ready() {
    log += "ready ";
    if (then) then(*this);
  }
  void take(const protocol::ServerMessage& message) {
    log += json::parse(protocol::write(message))["type"].get<std::string>() + " ";
    if (std::holds_alternative<protocol::Applied>(message)) link->close();
  }
  void take(std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
    log += "frame:" + std::to_string(events.size()) + ":" + std::to_string(bytes) + " ";
  }

  EventLoop loop;
  std::string log;
  Closing closing{.cause = CloseCause::asked, .failure = {}};
  int closings = 0;
  std::function<void(Visit&)> then;
  std::optional<Link> link;
};

protocol::EditMessage small_edit(protocol::MessageId id) {
  protocol::EditMessage message{.id = id, .edit = {}};
  message.edit.path = {{1, 2}};
  message.edit.radius = 3;
  return message;
}

/// Answers the hello and the join, and keeps what it was told.
void greet(Peer& peer, std::vector<std::string>& heard) {
  heard.push_back(peer.read());
  peer.write(kWelcome);
  heard.push_back(peer.read());
  peer.write(kJoined);
}

TEST(Link, SaysHelloAndJoinsAndSendsEdits) {
  std::vector<std::string> heard;
  {
    const FakeServer server("earthwork.v1", [&](Peer& peer) {
      greet(peer, heard);
      heard.push_back(peer.read());
      peer.write(R"({"type":"applied","id":1,"seq":4})");
      heard.push_back(peer.read());
    });
    const Visit visit(server.address(), [](Visit& v) {
      EXPECT_FALSE(v.link->congested());
      EXPECT_TRUE(v.link->send(small_edit(1)));
    });
    EXPECT_EQ(visit.log, "welcome joined ready applied ");
    EXPECT_EQ(visit.closing.cause, CloseCause::asked);
    EXPECT_EQ(visit.closings, 1);
  }
  ASSERT_EQ(heard.size(), 4u);
  EXPECT_EQ(json::parse(heard[0])["type"], "hello");
  EXPECT_EQ(json::parse(heard[0])["name"], "tester");
  EXPECT_EQ(heard[1], R"({"type":"join","map":"demo"})");
  EXPECT_EQ(json::parse(heard[2])["type"], "edit");
  EXPECT_EQ(json::parse(heard[2])["id"], 1);
  EXPECT_EQ(heard[3], "closed 1000");
}

TEST(Link, IsReadyAfterTheWelcomeWhenThereIsNoMapToJoin) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.read();
    peer.write(kWelcome);
    peer.read();
  });
  const Visit visit(
      server.address(), [](Visit& v) { v.link->close(); }, "");
  EXPECT_EQ(visit.log, "welcome ready ");
}

TEST(Link, HandsFramesOn) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    peer.write_binary(protocol::encode(protocol::GroupBegin{.epoch = 0xaa, .seq = 4, .view = 1}));
    peer.write_binary(protocol::encode(protocol::GroupEnd{.seq = 4}));
    peer.write(R"({"type":"applied","id":1,"seq":4})");
    peer.read();
  });
  const Visit visit(server.address());
  const auto begin = protocol::encode(protocol::GroupBegin{}).size();
  const auto end = protocol::encode(protocol::GroupEnd{}).size();
  EXPECT_EQ(visit.log, "welcome joined ready frame:1:" + std::to_string(begin) +
                           " frame:1:" + std::to_string(end) + " applied ");
}

TEST(Link, SaysWhyTheJoinWasRefused) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.read();
    peer.write(kWelcome);
    peer.read();
    peer.write(R"({"type":"rejected","code":"unknown_map","message":"there is no map demo"})");
    peer.read();
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.log, "welcome rejected ");
  EXPECT_EQ(visit.closing.cause, CloseCause::refused);
  EXPECT_EQ(visit.closing.failure.code, Code::unknown_map);
  EXPECT_EQ(visit.closing.failure.detail, "there is no map demo");
}

TEST(Link, SaysWhyTheHelloWasRefused) {
  const FakeServer server("earthwork.v1", [](Peer& peer) {
    peer.read();
    peer.write(R"({"type":"bye","code":"bad_version","message":"only version 2"})");
    peer.close(1000);
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.closing.cause, CloseCause::refused);
  EXPECT_EQ(visit.closing.failure.code, Code::bad_version);
}

TEST(Link, IsLostWithTheReasonOfABye) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    peer.write(R"({"type":"bye","code":"internal","message":"the server stops"})");
    peer.close(1001);
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.log, "welcome joined ready bye ");
  EXPECT_EQ(visit.closing.cause, CloseCause::lost);
  EXPECT_EQ(visit.closing.failure.detail, "the server stops");
}

TEST(Link, IsLostWhenTheServerLeavesWithoutABye) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    peer.close(1000);
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.closing.cause, CloseCause::lost);
  EXPECT_EQ(visit.closing.failure.detail, server.address().text() + " closed the connection");
}

TEST(Link, IsLostOnWhatIsNoMessage) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    peer.write("not json");
    peer.read();
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.closing.cause, CloseCause::lost);
  EXPECT_EQ(visit.closing.failure.code, Code::bad_json);
  EXPECT_NE(visit.closing.failure.detail.find("sent what is no message: "), std::string::npos);
}

TEST(Link, IsLostOnWhatIsNoFrame) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    peer.write_binary("\xff\xff\xff");
    peer.read();
  });
  const Visit visit(server.address());
  EXPECT_EQ(visit.closing.cause, CloseCause::lost);
  EXPECT_NE(visit.closing.failure.detail.find("sent what is no frame: "), std::string::npos);
}

TEST(Link, NamesAServerThatCannotBeReached) {
  const ServerAddress address = nobody();
  const Visit visit(address);
  EXPECT_EQ(visit.closing.cause, CloseCause::unreachable);
  EXPECT_EQ(visit.closing.failure.detail,
            address.text() + " cannot be reached: Connection refused");
  EXPECT_EQ(visit.closings, 1);
}

TEST(Link, SendsNothingBeforeItIsReadyOrAfterItsClose) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    heard.push_back(peer.read());
  });
  EventLoop loop;
  Link early(loop, {.server = server.address(), .hello = {}, .map = "demo"}, {});
  const auto sent = early.send(small_edit(1));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, Code::bad_state);

  early.close();
  EXPECT_FALSE(early.send(small_edit(1)));
  loop.run();
}

TEST(Link, RefusesToSendWhatAServerWouldRefuse) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    heard.push_back(peer.read());
  });
  const Visit visit(server.address(), [](Visit& v) {
    auto message = small_edit(1);
    message.edit.is_path = true;
    message.edit.path.assign(20'000, {0.5, 0.5});
    const auto sent = v.link->send(message);
    ASSERT_FALSE(sent);
    EXPECT_EQ(sent.error().code, Code::too_large);
    EXPECT_NE(sent.error().detail.find("beyond the limit of 65536"), std::string::npos);
    v.link->close();
  });
}

TEST(Link, LetsOnlySoMuchWait) {
  std::vector<std::string> heard;
  const FakeServer server("earthwork.v1", [&](Peer& peer) {
    greet(peer, heard);
    while (!peer.read().starts_with("closed")) {
    }
  });
  const Visit visit(server.address(), [](Visit& v) {
    auto message = small_edit(1);
    message.edit.is_path = true;
    message.edit.path.assign(1024, {123456.123456789, 123456.123456789});
    std::size_t sent = 0;
    while (v.link->send(message)) ++sent;
    EXPECT_TRUE(v.link->congested());
    const std::size_t bytes = protocol::write(protocol::ClientMessage(message)).size();
    EXPECT_EQ(sent, kMaxQueueBytes / bytes);
    v.link->close();
  });
}

}  // namespace
}  // namespace earthwork::link
