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

class Watch : public testing::Test {
 protected:
  void paint(const std::string& script) {
    const Outcome run = bot({"run", kConformance + script + ".jsonl", "--server", server_.url(),
                             "--map", "demo", "--create"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  std::vector<std::string> arguments(std::vector<std::string> more) {
    more.insert(more.begin(), {"watch", "--server", server_.url(), "--map", "demo"});
    return more;
  }
  Outcome watch(const std::vector<std::string>& more = {}) { return bot(arguments(more)); }

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
  const Outcome outcome = watch({"--until-seq", "5", "--seconds", "0.1"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.err, "seq 5 was not reached, only 4\n");
  EXPECT_EQ(report(outcome)["seq"], 4);
}

TEST_F(Watch, WatchesForSoLongWhenOnlyATimeIsGiven) {
  paint("07_circles");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(watch({"--seconds", "0.3"}).exit_code, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 300ms);
}

TEST_F(Watch, PrintsItsFiguresWhenInterruptedAndWhenTheServerGoesAway) {
  paint("07_circles");
  for (const bool interrupted : {true, false}) {
    Program program("earthwork-bot", arguments({"--until-seq", "100"}));
    ASSERT_TRUE(wait_for_users(server_, "demo", 1));
    std::this_thread::sleep_for(100ms);  // the view and its frames follow at once
    if (interrupted)
      program.signal(SIGINT);
    else
      server_.ask_to_end();
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(report(outcome)["chunks"], 4) << outcome.out;
  }
}

TEST_F(Watch, NamesAMapThatIsNotThereAndAFileThatCannotBeWritten) {
  const Outcome nowhere = watch();
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_EQ(nowhere.err, "map: there is no demo\n");
  paint("07_circles");
  const Outcome unwritten = watch({"--glb", folder_ / "no/such/folder.glb"});
  EXPECT_EQ(unwritten.exit_code, 1);
  EXPECT_EQ(unwritten.err, "'" + (folder_ / "no/such/folder.glb") + "' cannot be written\n");
}

}  // namespace
}  // namespace earthwork::e2e
