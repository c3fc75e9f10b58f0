// A server that keeps its maps on disk, over real sockets: what it said stays true when it is
// started again.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "protocol/messages.hpp"
#include "server/journal/shelf.hpp"
#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using protocol::Code;
namespace fs = std::filesystem;

const std::string kKey = "00112233445566778899aabbccddeeff";

/// Somebody with the key above, or another one, who joined a map, or tried to.
class Guest {
 public:
  Guest(std::uint16_t port, const std::string& map, const std::string& key = kKey) : client_(port) {
    client_.text(R"({"type":"hello","protocol":[1,1],"name":"ann","key":")" + key + "\"}");
    hear<protocol::Welcome>();
    client_.text(R"({"type":"join","map":")" + map + "\",\"id\":2}");
    answer = next();
  }
  [[nodiscard]] const protocol::Joined& joined() const {
    return std::get<protocol::Joined>(answer);
  }
  /// The number that the edit got.
  std::uint64_t paint(int id, double x) {
    client_.text(R"({"type":"edit","stencil":"circle","fill":true,"y":4,"radius":3,"id":)" +
                 std::to_string(id) + ",\"x\":" + std::to_string(x) + "}");
    const auto applied = hear<protocol::Applied>();
    EXPECT_EQ(applied.id, id);
    return applied.seq;
  }
  /// How many binary messages come until the view is complete, and as of which seq that is.
  struct Seen {
    int frames = 0;
    std::uint64_t seq = 0;
  };
  Seen look(const std::string& have = {}) {
    client_.text(R"({"type":"view","n":1,"all":true)" + have + "}");
    Seen seen;
    for (;;) {
      const auto received = client_.receive();
      if (received.kind == SocketClient::Kind::binary) {
        ++seen.frames;
        continue;
      }
      if (received.kind != SocketClient::Kind::text) throw std::runtime_error("no view");
      const auto message = protocol::parse_server_message(received.bytes).value();
      if (const auto* done = std::get_if<protocol::CaughtUp>(&message)) {
        seen.seq = done->seq;
        return seen;
      }
    }
  }

  protocol::ServerMessage answer;  // to the join

 private:
  protocol::ServerMessage next() {
    for (;;) {
      auto message = protocol::parse_server_message(client_.receive_text()).value();
      if (!std::holds_alternative<protocol::Presence>(message)) return message;
    }
  }
  template <class T>
  T hear() {
    return std::get<T>(next());
  }

  SocketClient client_;
};

struct KeptTest : testing::Test {
  KeptTest() {
    std::string made = (fs::temp_directory_path() / "earthwork-XXXXXX").string();
    folder = mkdtemp(made.data());
    start();
  }
  ~KeptTest() override {
    server.reset();
    fs::remove_all(folder);
  }

  void start(std::chrono::milliseconds idle = 1min) {
    server.reset();
    auto directory =
        journal::DataDirectory::open(folder, journal::DataDirectory::Missing::create).value();
    server = Server::start({.listen = {"127.0.0.1", 0},
                            .allowed_hosts = {},
                            .limits = {},
                            .shelf = journal::make_file_shelf(std::move(directory)),
                            .idle = idle})
                 .value();
    port = server->address().port;
  }
  void restart(std::chrono::milliseconds idle = 1min) {
    EXPECT_TRUE(server->stop());
    start(idle);
  }
  void create(const std::string& map) const {
    const std::string body = R"({"name":")" + map + R"(","settings":{"chunk_resolution":8}})";
    EXPECT_EQ(send("POST", "/api/maps", body).status, 201);
  }
  [[nodiscard]] HttpAnswer send(const std::string& method, const std::string& target,
                                const std::string& body = {}) const {
    return http(port, method + " " + target + " HTTP/1.1\r\nHost: " + server->address().text() +
                          "\r\nConnection: close\r\nContent-Type: application/json\r\n" +
                          "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  [[nodiscard]] json describe(const std::string& map) const {
    return json::parse(http_get(port, "/api/maps/" + map).body);
  }
  /// The value of a metric that has no label.
  [[nodiscard]] double metric(const std::string& name) const {
    const std::string page = http_get(port, "/metrics").body;
    const auto at = page.find("\n" + name + " ");
    if (at == std::string::npos) throw std::runtime_error("no metric " + name);
    return std::stod(page.substr(at + name.size() + 2));
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder / name; }
  /// Waits, at most a minute.
  static bool comes(const std::function<bool()>& true_now) {
    const auto give_up = std::chrono::steady_clock::now() + 1min;
    while (!true_now()) {
      if (std::chrono::steady_clock::now() > give_up) return false;
      std::this_thread::sleep_for(20ms);
    }
    return true;
  }

  fs::path folder;
  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

TEST_F(KeptTest, AMapIsTheSameAfterARestart) {
  create("m");
  std::string epoch;
  {
    Guest guest(port, "m");
    epoch = guest.joined().epoch;
    for (int i = 1; i <= 5; ++i) EXPECT_EQ(guest.paint(i, 10.0 * i), static_cast<unsigned>(i));
  }
  json before = describe("m");
  restart();
  EXPECT_EQ(http_get(port, "/api/maps").body, "{\"maps\":[{\"name\":\"m\"}]}\n");
  Guest guest(port, "m");
  EXPECT_EQ(guest.joined().epoch, epoch);
  EXPECT_EQ(guest.joined().seq, 5u);
  json after = describe("m");
  before.erase("users"), after.erase("users");
  EXPECT_EQ(after, before);
}

TEST_F(KeptTest, AnEditThatIsSentAgainAfterARestartGetsTheSameNumber) {
  create("m");
  {
    Guest guest(port, "m");
    EXPECT_EQ(guest.paint(5, 10), 1u);
    EXPECT_EQ(guest.paint(7, 20), 2u);
  }
  restart();
  Guest guest(port, "m");
  EXPECT_EQ(guest.paint(5, 10), 1u);
  EXPECT_EQ(guest.paint(7, 20), 2u);
  EXPECT_EQ(guest.paint(8, 30), 3u);
}

TEST_F(KeptTest, WhatAClientHoldsIsNotSentAgainAfterARestart) {
  create("m");
  std::string have;
  {
    Guest guest(port, "m");
    for (int i = 1; i <= 5; ++i) guest.paint(i, 40.0 * i);
    const auto seen = guest.look();
    EXPECT_GE(seen.frames, 1);
    EXPECT_EQ(seen.seq, 5u);
    have = R"(,"have":{"epoch":")" + guest.joined().epoch +
           R"(","seq":5,"rect":[-1000,-1000,1000,1000]})";
  }
  restart();
  Guest guest(port, "m");
  const auto seen = guest.look(have);
  EXPECT_EQ(seen.frames, 0);
  EXPECT_EQ(seen.seq, 5u);
  EXPECT_GE(Guest(port, "m").look().frames, 1);  // who holds nothing is sent all
}

TEST_F(KeptTest, ADeletedMapLeavesNoFile) {
  create("m");
  create("other");
  Guest guest(port, "m");
  guest.paint(1, 10);
  EXPECT_EQ(send("DELETE", "/api/maps/m").status, 204);
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_FALSE(entry.path().filename().string().starts_with("m.")) << entry.path();
  EXPECT_EQ(http_get(port, "/api/maps/m").status, 404);
  restart();
  EXPECT_EQ(http_get(port, "/api/maps/m").status, 404);
  EXPECT_EQ(http_get(port, "/api/maps/other").status, 200);
  create("m");
  EXPECT_EQ(Guest(port, "m").joined().seq, 0u);
}

TEST_F(KeptTest, ADamagedMapIsRefusedAndTheOthersAreServed) {
  create("bad");
  create("good");
  Guest(port, "bad").paint(1, 10);
  Guest(port, "good").paint(1, 10);
  EXPECT_TRUE(server->stop());
  fs::resize_file(file("bad.earthwork"), 5000);
  start();
  Guest refused(port, "bad");
  const auto& failure = std::get<protocol::Rejected>(refused.answer).failure;
  EXPECT_EQ(failure.code, Code::damaged);
  EXPECT_NE(failure.detail.find("bad.earthwork"), std::string::npos) << failure.detail;
  const auto answer = http_get(port, "/api/maps/bad");
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ(json::parse(answer.body).at("type"), "urn:earthwork:damaged");
  EXPECT_EQ(Guest(port, "good").joined().seq, 1u);
  EXPECT_EQ(json::parse(http_get(port, "/api/maps").body).at("maps").size(), 2u);
  EXPECT_EQ(fs::file_size(file("bad.earthwork")), 5000u);  // nobody has mended it
}

TEST_F(KeptTest, AMapThatNobodyUsesLeavesMemoryAndComesBack) {
  create("m");
  restart(300ms);
  EXPECT_EQ(metric("earthwork_maps"), 1);
  EXPECT_EQ(metric("earthwork_open_maps"), 0);
  {
    Guest guest(port, "m");
    guest.paint(1, 10);
    EXPECT_EQ(metric("earthwork_open_maps"), 1);
    EXPECT_TRUE(fs::exists(file("m.earthwork-wal")));
  }
  EXPECT_TRUE(comes([&] { return metric("earthwork_open_maps") == 0; }));
  EXPECT_TRUE(comes([&] { return !fs::exists(file("m.earthwork-wal")); }));
  Guest guest(port, "m");
  EXPECT_EQ(guest.joined().seq, 1u);
  EXPECT_EQ(guest.paint(2, 20), 2u);
}

TEST_F(KeptTest, CountsItsCommits) {
  create("m");
  Guest guest(port, "m");
  for (int i = 1; i <= 3; ++i) guest.paint(i, 10);
  EXPECT_EQ(metric("earthwork_committed_events_total"), 3);
  EXPECT_EQ(metric("earthwork_commits_total"), 3);
  EXPECT_GT(metric("earthwork_commit_seconds_total"), 0);
  EXPECT_EQ(metric("earthwork_waiting_events"), 0);
}

TEST_F(KeptTest, ManyMapsAreKnownAndFewAreOpen) {
  for (int i = 0; i < 30; ++i) create("map" + std::to_string(i));
  restart();
  EXPECT_EQ(metric("earthwork_maps"), 30);
  EXPECT_EQ(metric("earthwork_open_maps"), 0);
  Guest guest(port, "map7");
  EXPECT_EQ(guest.paint(1, 10), 1u);
  EXPECT_EQ(metric("earthwork_open_maps"), 1);
}

// Rooms are put away, asked for and asked about at every moment of each other.
TEST_F(KeptTest, NothingIsLostWhileMapsComeAndGo) {
  for (const char* map : {"a", "b", "c"}) create(map);
  restart(10ms);
  std::atomic<bool> painted{false};
  std::atomic<int> unanswered{0};
  std::thread asker([&] {
    while (!painted)
      for (const char* target : {"/api/maps/a/figures", "/api/maps/b", "/metrics"})
        if (http_get(port, target).status != 200) ++unanswered;
  });
  const auto paint = [this](const std::string& map, int pause_ms) {
    const std::string key = kKey.substr(1) + map;
    for (int i = 1; i <= 12; ++i) {
      EXPECT_EQ(Guest(port, map, key).paint(i, 5.0 * i), static_cast<unsigned>(i)) << map;
      std::this_thread::sleep_for(pause_ms * i * 1ms);
    }
  };
  {
    std::vector<std::jthread> painters;
    int pause_ms = 5;
    for (const char* map : {"a", "b", "c"}) painters.emplace_back(paint, map, pause_ms++);
  }
  painted = true;
  asker.join();
  EXPECT_EQ(unanswered, 0);
  restart();
  for (const char* map : {"a", "b", "c"}) EXPECT_EQ(describe(map).at("seq"), 12);
}

}  // namespace
}  // namespace earthwork::net
