// A server that is killed at any moment while eight bots paint: no edit that was answered is
// missing, none is there twice, and what a viewer was told before is true afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <string>

#include "client/link/event_loop.hpp"
#include "client/link/link.hpp"
#include "client/link/maps.hpp"
#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;

constexpr int kBots = 8;
constexpr int kEditsAKill = 40;  // of each bot: so that they paint all the while
constexpr const char* kMap = "crowd";

/// How often it is killed: EARTHWORK_KILLS, or a few times.
int kills() {
  const char* asked = std::getenv("EARTHWORK_KILLS");
  return asked ? std::max(1, std::atoi(asked)) : 6;
}

/// What a viewer heard of the map, over all lives of the server.
struct Memory {
  std::string epoch;
  std::uint64_t newest = 0;                      // seq: of a join, a view, a group or an event
  std::map<std::uint64_t, protocol::Event> log;  // by seq
  int contradictions = 0;

  void saw(std::uint64_t seq) { newest = std::max(newest, seq); }
  void saw(const protocol::Event& event) {
    saw(event.seq);
    const auto [known, first] = log.emplace(event.seq, event);
    if (!first && !(known->second == event)) ++contradictions;
  }
};

/// Joins for one life of the server: sees everything and hears all events from `from` on, until
/// the connection is lost or `until` was heard.
class Witness {
 public:
  Witness(link::EventLoop& loop, const ServerProgram& server, Memory& memory, std::uint64_t from,
          std::optional<std::uint64_t> until = {})
      : memory_(memory),
        until_(until),
        link_(loop, {.server = server.address(), .hello = hello(), .map = kMap},
              {.ready = [this, from] { look(from); },
               .message = [this](const auto& message) { take(message); },
               .frame = [this](const auto& events, std::size_t) { take_groups(events); },
               .closed = [&loop](const auto&) { loop.stop(); }}) {}

 private:
  static protocol::Hello hello() {
    protocol::Hello out;
    out.name = "witness";
    return out;
  }
  void look(std::uint64_t from) {
    const bool said = link_.send(protocol::View{.n = 1, .rect = {}, .have = {}, .id = {}}) &&
                      link_.send(protocol::Events{.from_seq = from, .id = {}});
    EXPECT_TRUE(said);
  }
  void take(const protocol::ServerMessage& message) {
    if (const auto* joined = std::get_if<protocol::Joined>(&message)) {
      EXPECT_GE(joined->seq, memory_.newest) << "an event that was seen is gone";
      if (memory_.epoch.empty()) memory_.epoch = joined->epoch;
      EXPECT_EQ(joined->epoch, memory_.epoch);
      memory_.saw(joined->seq);
    } else if (const auto* caught_up = std::get_if<protocol::CaughtUp>(&message)) {
      memory_.saw(caught_up->seq);
    } else if (const auto* event = std::get_if<protocol::Event>(&message)) {
      memory_.saw(*event);
      if (until_ && event->seq >= *until_) link_.close();
    }
  }
  void take_groups(const std::vector<protocol::FrameEvent>& events) {
    for (const protocol::FrameEvent& event : events)
      if (const auto* end = std::get_if<protocol::GroupEnd>(&event)) memory_.saw(end->seq);
  }

  Memory& memory_;
  std::optional<std::uint64_t> until_;
  link::Link link_;
};

/// Circles and squares, some of which empty what others filled.
std::string strokes(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::string out;
  for (int i = 0; i < count; ++i)
    out += json{{"stencil", between(0, 1) != 0 ? "circle" : "square"},
                {"fill", between(0, 2) != 0},
                {"x", between(-1280, 1280) / 16.0},
                {"y", between(-1280, 1280) / 16.0},
                {"radius", between(8, 80) / 16.0}}
               .dump() +
           "\n";
  return out;
}

class Kill : public testing::Test {
 protected:
  std::unique_ptr<ServerProgram> serve() {
    auto server = std::make_unique<ServerProgram>(
        ServerProgram::Flags{.data = folder_ / "data", .port = port_});
    port_ = server->address().port;
    return server;
  }
  std::unique_ptr<Program> paint(const ServerProgram& server, int bot, int edits) {
    const std::string script = folder_ / ("script" + std::to_string(bot) + ".jsonl");
    std::ofstream(script) << strokes(edits, static_cast<unsigned>(bot));
    return std::make_unique<Program>(
        "earthwork-bot", std::vector<std::string>{"run", script, "--server", server.url(), "--map",
                                                  kMap, "--window", "16", "--rate", "80"});
  }
  /// One life: from now until it is killed at a moment that is drawn by lot.
  void witness_a_life(ServerProgram& server) {
    link::EventLoop loop;
    link::Timer death(loop);
    death.start(milliseconds(std::uniform_int_distribution<int>(20, 700)(random_)),
                [&] { server.kill(); });
    // Some events that it knows are told again.
    const std::uint64_t from = memory_.log.empty() ? 1 : memory_.log.rbegin()->first;
    const Witness witness(loop, server, memory_, std::max<std::uint64_t>(from, 51) - 50);
    loop.run();
    server.kill();  // in case the connection was lost before
  }

  Folder folder_;
  std::uint16_t port_ = 0;
  Memory memory_;
  std::mt19937 random_{20};
};

TEST_F(Kill, LosesNothingThatWasAnsweredAndAppliesNothingTwice) {
  const int edits = kEditsAKill * kills();
  auto server = serve();
  protocol::MapSettings settings;
  settings.chunk_resolution = 16;
  ASSERT_TRUE(link::create_map(server->address(), kMap, settings));

  std::vector<std::unique_ptr<Program>> bots;
  for (int i = 0; i < kBots; ++i) bots.push_back(paint(*server, i, edits));
  const std::uint64_t all = static_cast<std::uint64_t>(kBots) * static_cast<std::uint64_t>(edits);
  Program watch("earthwork-bot", {"watch", "--server", server->url(), "--map", kMap, "--until-seq",
                                  std::to_string(all)});
  for (int n = 0; n < kills(); ++n) {
    witness_a_life(*server);
    server = serve();
  }

  for (const auto& bot : bots) {
    const Outcome outcome = bot->wait();
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(report(outcome)["acked"], edits);
    EXPECT_EQ(report(outcome)["rejected"], 0);
  }
  const Outcome watched = watch.wait();
  EXPECT_EQ(watched.exit_code, 0) << watched.err;
  EXPECT_EQ(report(watched)["mesh_hash"], figures(*server, kMap)["mesh_hash"]);

  // Now the whole log once more: it contradicts nothing that was heard.
  link::EventLoop loop;
  const Witness witness(loop, *server, memory_, 1, all);
  loop.run();
  EXPECT_EQ(memory_.contradictions, 0);
  ASSERT_EQ(memory_.log.size(), all);
  EXPECT_EQ(memory_.newest, all);
  std::map<std::string, int> by_author;
  for (const auto& [seq, event] : memory_.log) ++by_author[event.author];
  EXPECT_EQ(by_author.size(), std::size_t{kBots});
  for (const auto& [author, count] : by_author) EXPECT_EQ(count, edits) << author;

  const std::string hash = figures(*server, kMap)["hash"];
  EXPECT_EQ(hash, memory_.log.rbegin()->second.hash);
  server.reset();
  const Outcome verified =
      Program("earthwork-server", {"map", "verify", kMap, "--data", folder_ / "data"}).wait();
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(report(verified)["hash"], hash);
  EXPECT_EQ(report(verified)["events"], all);
}

}  // namespace
}  // namespace earthwork::e2e
