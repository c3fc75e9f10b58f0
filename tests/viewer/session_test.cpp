// A viewer's connection: what it says first, how it comes back, and that no edit is lost or made
// twice.
#include "client/viewer/session.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <deque>
#include <map>

#include "protocol/frame.hpp"
#include "tests/viewer/played_server.hpp"

namespace earthwork::viewer {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using protocol::Code;
using protocol::MapPoint;
using State = ConnectionPart::State;

ConnectionPart connection(PlayedServer& server) {
  const auto part = server.viewer->panels(server.now).connection;
  EXPECT_TRUE(part);
  return part.value_or(ConnectionPart{});
}

protocol::Bye bye(Code code) {
  return {.failure = {.code = code, .detail = "because", .field = {}}, .retry_after_ms = {}};
}

void stamp(PlayedServer& server, double x, double y) {
  server.press(x, y);
  server.release(x, y);
}

TEST(Session, SaysHelloJoinAndViewInTheTurnsOfTheirAnswers) {
  PlayedServer server;
  EXPECT_EQ(server.shell.connects, 1);
  EXPECT_TRUE(server.shell.sent.empty());
  EXPECT_EQ(connection(server).state, State::connecting);
  server.join();
  const auto& sent = server.shell.sent;
  ASSERT_GE(sent.size(), 3u);
  EXPECT_EQ(json::parse(sent[0]), json::parse(R"({"type":"hello","protocol":[1,1],"name":"Me",
                                                  "color":"#112233"})"));
  EXPECT_EQ(json::parse(sent[1]), json::parse(R"({"type":"join","map":"demo"})"));
  EXPECT_EQ(json::parse(sent[2])["type"], "view");
  const auto part = connection(server);
  EXPECT_EQ(part.state, State::joined);
  EXPECT_EQ(part.key, kKey);
  EXPECT_EQ(part.session, kMe);
}

TEST(Session, ComesBackWithItsKeyAndWhatItHas) {
  PlayedServer server;
  server.join(bounded(), kEpoch, 7);
  server.show({{0, 0, 0, 0}}, 7);
  server.catch_up(7);
  server.cut();
  const auto lost = connection(server);
  EXPECT_EQ(lost.state, State::lost);
  ASSERT_TRUE(lost.retry_ms);
  EXPECT_LE(*lost.retry_ms, 250);
  EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);  // the view stays
  server.pass(250ms);
  EXPECT_EQ(server.shell.connects, 2);
  server.join(bounded(), kEpoch, 9);
  EXPECT_EQ(server.last("hello")["key"], kKey);
  EXPECT_EQ(server.last("view")["have"]["seq"], 7);
  EXPECT_EQ(server.last("view")["have"]["epoch"], kEpoch);
  EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);
}

TEST(Session, NeverGivesUp) {
  PlayedServer server;
  for (int i = 0; i < 40; ++i) {
    server.viewer->disconnected(1006, "", server.now);
    const auto lost = server.now;
    server.await_connect();
    EXPECT_LE(server.now - lost, 30s);
  }
  server.cut();
  EXPECT_EQ(connection(server).state, State::lost);
}

TEST(Session, AConnectionThatDoesNotAnswerIsDropped) {
  PlayedServer server;
  server.pass(kAnswerTimeout);
  EXPECT_EQ(server.shell.disconnects, 1);
  server.pass(1s);
  EXPECT_EQ(server.shell.connects, 2);
  server.viewer->connected(server.now);
  server.pass(kAnswerTimeout + 1s);
  EXPECT_EQ(server.shell.connects, 3);
  server.greet();
  server.pass(kAnswerTimeout + 1s);
  EXPECT_EQ(server.shell.connects, 4);
}

TEST(Session, MeasuresLatencyAndNoticesSilence) {
  PlayedServer server;
  server.join();
  ASSERT_EQ(server.count("ping"), 1u);
  server.pass(40ms);
  server.say(protocol::Done{.id = kPingId});
  server.pass(1s);
  EXPECT_EQ(server.viewer->panels(server.now).status->latency_ms, 40);
  server.pass(2s);
  EXPECT_EQ(server.count("ping"), 2u);
  server.pass(kSilence - 1s);
  EXPECT_EQ(server.shell.disconnects, 0);
  server.pass(1s);
  EXPECT_EQ(server.shell.disconnects, 1);
  EXPECT_EQ(connection(server).state, State::lost);
}

TEST(Session, AMapThatIsDeletedEndsIt) {
  for (const Code code : {Code::unknown_map, Code::bad_version}) {
    PlayedServer server;
    server.join();
    server.say(bye(code));
    const auto part = connection(server);
    EXPECT_EQ(part.state, State::ended);
    EXPECT_FALSE(part.words.empty());
    EXPECT_FALSE(part.retry_ms);
    server.pass(600s);
    EXPECT_EQ(server.shell.connects, 1);
    ASSERT_TRUE(server.viewer->command(RetryNow{}, server.now));
    EXPECT_EQ(server.shell.connects, 2);
  }
}

TEST(Session, AServerThatEndsIsTriedAgainWhenItSays) {
  PlayedServer server;
  server.join();
  server.say(protocol::Bye{.failure = {Code::shutting_down, "the server ends", {}},
                           .retry_after_ms = 4000});
  EXPECT_EQ(connection(server).state, State::lost);
  server.pass(3999ms);
  EXPECT_EQ(server.shell.connects, 1);
  server.pass(2001ms);
  EXPECT_EQ(server.shell.connects, 2);
}

TEST(Session, ARefusedJoinSaysWhy) {
  PlayedServer server;
  server.greet();
  server.say(protocol::Rejected{.id = {}, .failure = {Code::damaged, "the map is damaged", "map"}});
  const auto part = connection(server);
  EXPECT_EQ(part.state, State::ended);
  EXPECT_NE(part.words.find("the map is damaged"), std::string::npos);
}

TEST(Session, WhatIsNoMessageOrFrameDropsTheConnectionAndKeepsTheView) {
  const std::string begin = protocol::encode(protocol::GroupBegin{0xaa, 5, 1});
  const auto bad = {std::string("{"), std::string(R"({"type":"applied","id":-1})"),
                    std::string("\xff")};
  for (const std::string& text : bad) {
    PlayedServer server;
    server.join();
    server.show({{0, 0, 0, 0}});
    server.viewer->text(text, server.now);
    EXPECT_EQ(server.shell.disconnects, 1) << text;
    EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);
    server.pass(250ms);
    EXPECT_EQ(server.shell.connects, 2);
  }
  // Not of the format; then of the format, and impossible: a group inside another.
  for (const std::string& frames : {std::string("\x01\x07zz"), begin + "!", std::string()}) {
    PlayedServer server;
    server.join();
    server.show({{0, 0, 0, 0}});
    server.binary(frames);
    EXPECT_EQ(server.shell.disconnects, 1);
    EXPECT_EQ(connection(server).state, State::lost);
    server.show({{0, 1, 0, 0}});  // too late
    EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);
    server.pass(250ms);
    server.join();
    server.show({{0, 0, 0, 0}, {0, 1, 0, 0}});
    EXPECT_EQ(server.viewer->scene().chunks().size(), 2u);
  }
}

TEST(Session, AFailedSceneBeginsAnew) {
  PlayedServer server;
  server.join(bounded(), kEpoch, 5);
  server.show({{0, 0, 0, 0}});
  server.binary(protocol::encode(protocol::GroupBegin{0xaa, 5, 1}));
  server.binary(protocol::encode(protocol::GroupEnd{5}));
  server.binary(protocol::encode(protocol::GroupBegin{0xaa, 3, 1}));  // goes back
  EXPECT_EQ(server.shell.disconnects, 1);
  EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);
  server.pass(250ms);
  server.join(bounded(), kEpoch, 5);
  EXPECT_FALSE(server.last("view").contains("have"));
  server.show({{0, 3, 0, 0}});
  EXPECT_EQ(server.viewer->scene().chunks().size(), 1u);
}

TEST(Session, IgnoresTypesOfLaterVersions) {
  PlayedServer server;
  server.join();
  server.viewer->text(R"({"type":"weather","sun":true})", server.now);
  EXPECT_EQ(server.shell.disconnects, 0);
}

TEST(Session, AnotherMapOfTheNameTellsWhatWasLost) {
  PlayedServer server;
  server.join(bounded());
  server.show({{0, 0, 0, 0}});
  stamp(server, 400, 300);
  stamp(server, 300, 300);
  server.cut();
  server.pass(250ms);
  server.join(bounded(), kOtherEpoch);
  EXPECT_EQ(server.count("edit"), 2u);
  EXPECT_TRUE(server.viewer->scene().chunks().empty());
  const auto notices = server.viewer->panels(server.now).notices->notices;
  ASSERT_EQ(notices.size(), 1u);
  EXPECT_EQ(notices[0].kind, NoticesPart::Notice::Kind::lost);
  EXPECT_EQ(notices[0].words.find("2 edits: "), 0u) << notices[0].words;
  EXPECT_TRUE(notices[0].at);
}

TEST(Session, OpensAnotherMapWithACleanScene) {
  PlayedServer server;
  server.join(bounded());
  server.show({{0, 0, 0, 0}});
  stamp(server, 400, 300);
  server.say(protocol::Applied{.id = 1, .seq = 2});
  ASSERT_TRUE(server.viewer->command(OpenMap{"other"}, server.now));
  EXPECT_EQ(server.shell.disconnects, 1);
  EXPECT_EQ(server.shell.connects, 2);
  EXPECT_TRUE(server.viewer->scene().chunks().empty());
  server.join(layered(2), kOtherEpoch);
  EXPECT_EQ(server.last("join")["map"], "other");
  EXPECT_EQ(server.last("hello")["key"], kKey);
  stamp(server, 400, 300);
  EXPECT_EQ(server.last("edit")["id"], 2);  // of one key they never go back
  const auto map = server.viewer->panels(server.now).map;
  ASSERT_TRUE(map);
  EXPECT_EQ(map->name, "other");
  EXPECT_EQ(map->epoch, kOtherEpoch);
}

TEST(Session, BecomesSomebodyElseWithTheSameKeyAndEdits) {
  PlayedServer server;
  server.join(bounded());
  stamp(server, 400, 300);
  ASSERT_TRUE(server.viewer->command(BePerson{"Jö", "#00ff00"}, server.now));
  EXPECT_EQ(server.shell.connects, 2);
  server.join(bounded());
  EXPECT_EQ(server.last("hello")["name"], "Jö");
  EXPECT_EQ(server.last("hello")["color"], "#00ff00");
  EXPECT_EQ(server.last("hello")["key"], kKey);
  EXPECT_EQ(server.all("edit").at(0), server.all("edit").at(1));
}

TEST(Session, IdsGoOnFromTheLastOne) {
  ViewerOptions options = PlayedServer::default_options();
  options.last_id = 41;
  options.hello.key = kKey;
  PlayedServer server(options);
  server.join();
  EXPECT_EQ(server.last("hello")["key"], kKey);
  stamp(server, 400, 300);
  EXPECT_EQ(server.last("edit")["id"], 42);
}

/// What a server remembers of an author: each id is applied once, in order.
class Ledger {
 public:
  protocol::ServerMessage take(const json& edit) {
    const protocol::MessageId id = edit["id"];
    const auto [at, fresh] = seqs_.emplace(id, seqs_.size() + 1);
    if (fresh) RC_ASSERT(std::next(at) == seqs_.end());
    return protocol::Applied{.id = id, .seq = at->second};
  }
  std::size_t applied() const { return seqs_.size(); }

 private:
  std::map<protocol::MessageId, std::uint64_t> seqs_;
};

/// A wire to the ledger that breaks: what is under way in either direction is gone then.
class Wire {
 public:
  explicit Wire(PlayedServer& server) : server_(server) {}
  void take_sent() {
    for (; read_ < server_.shell.sent.size(); ++read_)
      if (json message = json::parse(server_.shell.sent[read_]); message["type"] == "edit")
        up_.push_back(message);
  }
  void carry_up() {
    take_sent();
    if (up_.empty()) return;
    down_.push_back(ledger.take(up_.front()));
    up_.pop_front();
  }
  void carry_down() {
    if (down_.empty()) return;
    server_.say(down_.front());
    down_.pop_front();
  }
  void cut() {
    take_sent();
    up_.clear();
    down_.clear();
    server_.cut();
  }
  bool idle() {
    take_sent();
    return up_.empty() && down_.empty();
  }
  Ledger ledger;

 private:
  PlayedServer& server_;
  std::size_t read_ = 0;
  std::deque<json> up_;
  std::deque<protocol::ServerMessage> down_;
};

RC_GTEST_PROP(Session, MakesEachEditExactlyOnceOverAnyCuts, ()) {
  PlayedServer server;
  Wire wire(server);
  std::size_t painted = 0;
  bool up = false;
  const auto join = [&] {
    server.join(bounded());
    up = true;
  };
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 8));
  join();
  for (const int step : steps) {
    if (step < 3) {
      stamp(server, 300 + 10 * static_cast<double>(painted % 20), 300);
      ++painted;
    } else if (step < 5 && up) {
      wire.carry_up();
    } else if (step < 6 && up) {
      wire.carry_down();
    } else if (step == 6 && up) {
      wire.cut();
      server.await_connect();
      up = false;
    } else if (!up) {
      join();
    }
  }
  if (!up) join();
  while (!wire.idle()) {
    wire.carry_up();
    wire.carry_down();
  }
  RC_ASSERT(wire.ledger.applied() == painted);
  server.pass(1s);
  RC_ASSERT(server.viewer->panels(server.now).status->unanswered == 0u);
}

/// Something that a server might say at any time, sense or nonsense.
std::string any_text() {
  const auto n = *rc::gen::inRange<std::uint32_t>(0, 4);
  protocol::MapSettings settings = layered(*rc::gen::inRange<std::size_t>(1, 17));
  settings.layers[0].top = n;
  const std::string session = *rc::gen::element(kMe, kAnn, kBob);
  const protocol::Failure why{Code::internal, "because", {}};
  switch (*rc::gen::inRange(0, 10)) {
    case 0:
      return protocol::write(protocol::CaughtUp{.n = n, .seq = n});
    case 1:
      return protocol::write(protocol::SettingsChanged{.seq = n, .settings = settings});
    case 2:
      return protocol::write(protocol::Applied{.id = n + 1, .seq = n});
    case 3:
      return protocol::write(protocol::Rejected{.id = kPingId - n, .failure = why});
    case 4:
      return protocol::write(protocol::Presence{
          .all = n == 0,
          .users = {user(session, "x")},
          .left = {},
          .cursors = {{session, MapPoint{1e300, static_cast<double>(n)}, {}, {}}}});
    case 5:
      return protocol::write(protocol::Welcome{.session = session, .key = kKey, .id = {}});
    case 6:
      return protocol::write(protocol::Joined{.map = "demo",
                                              .settings = settings,
                                              .epoch = n == 0 ? kEpoch : kOtherEpoch,
                                              .seq = n,
                                              .users = {},
                                              .id = {}});
    case 7:
      return protocol::write(protocol::Done{.id = kPingId});
    case 8:
      return protocol::write(bye(Code::internal));
    default:
      return *rc::gen::arbitrary<std::string>();
  }
}

RC_GTEST_PROP(Session, SurvivesWhateverAServerSays, ()) {
  PlayedServer server;
  if (*rc::gen::inRange(0, 4) != 0) server.join(layered(2));
  for (int i = *rc::gen::inRange(0, 40); i > 0; --i) {
    switch (*rc::gen::inRange(0, 6)) {
      case 0:
        server.viewer->connected(server.now);
        break;
      case 1:
        server.binary(protocol::encode(protocol::GroupBegin{0xaa, 1, 1}) +
                      *rc::gen::arbitrary<std::string>());
        break;
      case 2:
        stamp(server, 400, 300);
        break;
      case 3:
        server.pass(std::chrono::milliseconds(*rc::gen::inRange(0, 40'000)));
        break;
      default:
        server.viewer->text(any_text(), server.now);
    }
    server.frame();
    static_cast<void>(server.viewer->panels(server.now));
    static_cast<void>(server.viewer->labels());
  }
  // And it comes back to a server that is one.
  server.cut();
  if (server.viewer->command(RetryNow{}, server.now))
    server.join(bounded(), "00000000000000cc", 50);
  server.show({{0, 0, 0, 0}});
  RC_ASSERT(server.viewer->scene().chunks().size() == 1u);
}

}  // namespace
}  // namespace earthwork::viewer
