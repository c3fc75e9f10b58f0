// earthwork-bot load: good viewers and bad ones, and all of them end with the server's meshes.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using nlohmann::json;

class Load : public testing::Test {
 protected:
  std::vector<std::string> arguments(std::vector<std::string> more) {
    more.insert(more.begin(), {"load", "--server", server_.url(), "--map", "demo"});
    return more;
  }
  Outcome load(const std::vector<std::string>& more) { return bot(arguments(more)); }

  ServerProgram server_;
};

json all_of(int viewers) { return {{"viewers", viewers}, {"agreeing", viewers}}; }

TEST_F(Load, EndsWithOneMeshForEverybodyHoweverTheyRead) {
  const Outcome outcome =
      load({"--create", "--editors", "3", "--viewers", "9", "--seconds", "3", "--rate", "60",
            "--slow", "1", "--stalled", "2", "--flaky", "3", "--threads", "2"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  const json line = report(outcome);
  EXPECT_EQ(line["healthy"], all_of(3));
  EXPECT_EQ(line["slow"], all_of(1));
  EXPECT_EQ(line["stalled"], all_of(2));
  EXPECT_EQ(line["flaky"], all_of(3));
  EXPECT_GE(line["reconnects"], 3);
  EXPECT_GT(line["edits"], 0);
  EXPECT_EQ(line["edits"], line["acked"]);
  EXPECT_EQ(line["seq"], line["acked"]);
  EXPECT_EQ(line["mesh_hash"], figures(server_, "demo")["mesh_hash"]);
}

TEST_F(Load, MeasuresWhatViewersReceive) {
  const Outcome outcome =
      load({"--create", "--editors", "2", "--viewers", "2", "--seconds", "1", "--rate", "50"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  const json line = report(outcome);
  EXPECT_GE(line["seconds"], 1.0);
  EXPECT_GT(line["frames"], line["records"]);
  EXPECT_GT(line["records"], 0);
  EXPECT_GT(line["bytes_per_edit_and_viewer"], 20.0);
  EXPECT_GT(line["voxel_bytes_per_edit"], 128.0);
  EXPECT_GT(line["ack_ms"]["p50"], 0.0);
  EXPECT_LE(line["ack_ms"]["p50"], line["ack_ms"]["p999"]);
  EXPECT_GT(line["view_ms"]["p50"], 0.0);
  EXPECT_EQ(line["reconnects"], 0);
}

TEST_F(Load, PaintsAsFastAsItIsAnsweredWithoutARate) {
  const Outcome outcome = load({"--create", "--editors", "2", "--viewers", "1", "--seconds", "1",
                                "--radius", "1.5", "--area", "40", "--seed", "9"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  EXPECT_GE(report(outcome)["edits"], 128);  // two windows
  EXPECT_EQ(report(outcome)["edits"], report(outcome)["acked"]);
}

TEST_F(Load, WatchesAMapThatStandsStillWithoutEditors) {
  const Outcome outcome =
      load({"--create", "--editors", "0", "--viewers", "2", "--seconds", "0.1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  EXPECT_EQ(report(outcome)["edits"], 0);
  EXPECT_EQ(report(outcome)["healthy"], all_of(2));
}

TEST_F(Load, EndsEarlyAndStillComparesWhenInterrupted) {
  Program program("earthwork-bot", arguments({"--create", "--editors", "1", "--viewers", "2",
                                              "--seconds", "1000", "--rate", "50"}));
  ASSERT_TRUE(wait_for_seq(server_, "demo", 10));
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(report(outcome)["healthy"], all_of(2));
  EXPECT_EQ(report(outcome)["edits"], report(outcome)["acked"]);
}

TEST_F(Load, RefusesFlagsThatDoNotDo) {
  const Outcome nowhere = load({"--editors", "1", "--viewers", "1", "--seconds", "1"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_NE(nowhere.err.find("there is no demo"), std::string::npos) << nowhere.err;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--seconds", "1"},
        {"--editors", "1", "--viewers", "1", "--seconds", "0"},
        {"--editors", "-1", "--viewers", "1", "--seconds", "1"},
        {"--editors", "1", "--viewers", "1", "--seconds", "1", "--rate", "0"},
        {"--editors", "1", "--viewers", "1", "--seconds", "1", "--threads", "0"},
        {"--editors", "1", "--viewers", "1", "--seconds", "1", "--slow", "2", "--create"}}) {
    const Outcome outcome = load(wrong);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err, "");
  }
}

}  // namespace
}  // namespace earthwork::e2e
