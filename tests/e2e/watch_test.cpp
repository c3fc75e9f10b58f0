// earthwork-bot watch: the mesh from frames alone is the mesh that the server exports.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

const std::string kConformance = std::string(EARTHWORK_SOURCE_DIR) + "/tests/conformance/";

/// How long the whole map takes to arrive is the machine's affair: where it has to be there by a
/// time that the test sets, the test takes the first of these that is enough.
const std::vector<std::chrono::milliseconds> kPeriods{100ms, 1000ms, 10000ms, 40000ms};

void paint(const ServerProgram& server, const std::string& script) {
  const Outcome run = bot({"run", kConformance + script + ".jsonl", "--server", server.url(),
                           "--map", "demo", "--create"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
}

std::vector<std::string> watching(const ServerProgram& server, std::vector<std::string> more) {
  more.insert(more.begin(), {"watch", "--server", server.url(), "--map", "demo"});
  return more;
}

class Watch : public testing::Test {
 protected:
  void paint(const std::string& script) { e2e::paint(server_, script); }
  std::vector<std::string> arguments(std::vector<std::string> more) {
    return watching(server_, std::move(more));
  }
  Outcome watch(const std::vector<std::string>& more = {}) { return bot(arguments(more)); }

  /// With --seconds.
  Outcome watch_long_enough(std::vector<std::string> more) {
    Outcome outcome;
    more.insert(more.end(), {"--seconds", ""});
    for (const auto period : kPeriods) {
      const std::chrono::duration<double> seconds = period;
      more.back() = std::to_string(seconds.count());
      const auto start = std::chrono::steady_clock::now();
      outcome = watch(more);
      EXPECT_GE(std::chrono::steady_clock::now() - start, seconds);
      if (outcome.err.find("not all of the map arrived") == std::string::npos) break;
      EXPECT_EQ(outcome.exit_code, 1);
    }
    return outcome;
  }

  Folder folder_;
  ServerProgram server_;
};

TEST_F(Watch, WritesTheGlbThatTheServerExports) {
  paint("10_corner_features");
  const Outcome outcome = watch({"--until-seq", "36", "--glb", folder_ / "out.glb"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string exported = get(server_, "/api/maps/demo/export.glb");
  EXPECT_GT(exported.size(), 1000u);
  EXPECT_TRUE(read_file(folder_ / "out.glb") == exported);
}

TEST_F(Watch, PrintsItsFiguresInTheirOrder) {
  paint("07_circles");
  const Outcome outcome = watch();
  EXPECT_EQ(outcome.exit_code, 0);
  std::string keys;
  const auto line = nlohmann::ordered_json::parse(outcome.out);
  for (const auto& [key, value] : line.items()) keys += key + " ";
  EXPECT_EQ(keys, "seq frames bytes chunks mesh_hash ");
  EXPECT_EQ(report(outcome)["seq"], 4);
  EXPECT_EQ(report(outcome)["mesh_hash"], figures(server_, "demo")["mesh_hash"]);
  EXPECT_EQ(report(outcome)["bytes"], figures(server_, "demo")["mesh_bytes"].get<int>() + 2);
}

TEST_F(Watch, FollowsEditsAsTheyAreMade) {
  paint("06_squares_exact");
  Program program("earthwork-bot", arguments({"--until-seq", "205", "--glb", folder_ / "out.glb"}));
  std::string script;
  for (int i = 0; i < 200; ++i)
    script += R"({"stencil":"circle","fill":)" + std::string(i % 3 == 2 ? "false" : "true") +
              R"(,"x":)" + std::to_string(i % 23 - 7) + R"(,"y":)" + std::to_string(i % 19 - 7) +
              R"(,"radius":2.25})" + "\n";
  std::ofstream(folder_ / "more.jsonl") << script;
  const Outcome run = bot({"run", folder_ / "more.jsonl", "--server", server_.url(), "--map",
                           "demo", "--rate", "1000"});
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(report(outcome)["seq"], 205);
  EXPECT_EQ(report(outcome)["mesh_hash"], figures(server_, "demo")["mesh_hash"]);
  EXPECT_TRUE(read_file(folder_ / "out.glb") == get(server_, "/api/maps/demo/export.glb"));
}

TEST_F(Watch, EndsWithOneWhenTheSequenceIsNotReachedInTime) {
  paint("07_circles");
  const Outcome outcome = watch_long_enough({"--until-seq", "5"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.err, "seq 5 was not reached, only 4\n");
  EXPECT_EQ(report(outcome)["seq"], 4);
}

TEST_F(Watch, WatchesForSoLongWhenOnlyATimeIsGiven) {
  paint("07_circles");
  EXPECT_EQ(watch_long_enough({}).exit_code, 0);
}

enum class End { by_a_signal, with_the_server };

Outcome watch_until(End end, std::chrono::milliseconds after) {
  const ServerProgram server;
  paint(server, "07_circles");
  EXPECT_TRUE(wait_for_users(server, "demo", 0));
  Program program("earthwork-bot", watching(server, {"--until-seq", "100", "--patience", "0"}));
  EXPECT_TRUE(wait_for_users(server, "demo", 1));
  std::this_thread::sleep_for(after);
  if (end == End::by_a_signal)
    program.signal(SIGINT);
  else
    server.ask_to_end();
  return program.wait();
}

TEST(WatchCutShort, PrintsItsFiguresWhenInterruptedAndWhenTheServerGoesAway) {
  for (const End end : {End::by_a_signal, End::with_the_server}) {
    Outcome outcome;
    for (const auto period : kPeriods) {
      outcome = watch_until(end, period);
      EXPECT_EQ(outcome.exit_code, 1);
      if (report(outcome)["chunks"] == 4) break;
    }
    EXPECT_EQ(report(outcome)["chunks"], 4) << outcome.out;
  }
}

TEST_F(Watch, NamesAMapThatIsNotThereAndAFileThatCannotBeWritten) {
  const Outcome nowhere = watch();
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_EQ(nowhere.out, "");
  EXPECT_EQ(nowhere.err, "map: there is no demo\n");
  for (const char* name : {"", "../demo", "Demo"}) {
    const Outcome misnamed = bot({"watch", "--server", server_.url(), "--map", name});
    EXPECT_EQ(misnamed.exit_code, 2);
    EXPECT_EQ(misnamed.out, "");
    EXPECT_EQ(misnamed.err,
              "map: '" + std::string(name) + "' is no map's name: 1-64 of a-z, 0-9, '-', '_'\n");
  }
  paint("07_circles");
  const Outcome unwritten = watch({"--glb", folder_ / "no/such/folder.glb"});
  EXPECT_EQ(unwritten.exit_code, 1);
  EXPECT_EQ(unwritten.err, "'" + (folder_ / "no/such/folder.glb") + "' cannot be written\n");
}

}  // namespace
}  // namespace earthwork::e2e
