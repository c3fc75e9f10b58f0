// earthwork-bot run: scripts painted over a real socket give the figures they should; and every way
// for it to end.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

const std::string kConformance = std::string(EARTHWORK_SOURCE_DIR) + "/tests/conformance/";

std::vector<std::string> scripts() {
  std::vector<std::string> out;
  const json expected = json::parse(read_file(kConformance + "expected.json"));
  for (const auto& [name, figures] : expected.items()) out.push_back(name);
  return out;
}

class Conformance : public testing::TestWithParam<std::string> {};

TEST_P(Conformance, GivesTheFiguresThroughTheWire) {
  const ServerProgram server;
  const Outcome run = bot({"run", kConformance + GetParam() + ".jsonl", "--server", server.url(),
                           "--map", "script", "--create"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json expected = json::parse(read_file(kConformance + "expected.json"))[GetParam()];
  EXPECT_EQ(report(run)["acked"], expected["edits"]);
  EXPECT_EQ(report(run)["seq"], expected["edits"]);

  const json got = figures(server, "script");
  for (const auto& [key, value] : expected.items()) {
    if (key == "surface_area" || key == "wall_length")
      EXPECT_NEAR(got[key].get<double>(), value.get<double>(), 1e-6 * value.get<double>()) << key;
    else
      EXPECT_EQ(got[key], value) << key;
  }
  const Outcome watch = bot({"watch", "--server", server.url(), "--map", "script"});
  EXPECT_EQ(report(watch)["mesh_hash"], got["mesh_hash"]);
  EXPECT_EQ(report(watch)["chunks"], got["meshed_chunks"]);
}

INSTANTIATE_TEST_SUITE_P(, Conformance, testing::ValuesIn(scripts()),
                         [](const auto& script) { return script.param; });

class Run : public testing::Test {
 protected:
  std::string script(const std::string& text) {
    std::ofstream(folder_ / "script.jsonl") << text;
    return folder_ / "script.jsonl";
  }
  std::vector<std::string> arguments(const std::string& text) {
    return {"run", script(text), "--server", server_.url(), "--map", "demo"};
  }
  Outcome run(const std::string& text, const std::vector<std::string>& more = {"--create"}) {
    auto all = arguments(text);
    all.insert(all.end(), more.begin(), more.end());
    return bot(all);
  }

  Folder folder_;
  ServerProgram server_;
};

const std::string kEdit = R"({"stencil":"circle","fill":true,"x":1,"y":2,"radius":3})"
                          "\n";

std::string many(int edits) {
  std::string out;
  for (int i = 0; i < edits; ++i) out += kEdit;
  return out;
}

TEST_F(Run, PrintsItsFiguresInTheirOrder) {
  const Outcome outcome = run(kEdit + kEdit);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  std::string keys;
  const auto line = nlohmann::ordered_json::parse(outcome.out);
  for (const auto& [key, value] : line.items()) keys += key + " ";
  EXPECT_EQ(keys, "edits acked rejected seconds ack_p50_ms ack_p99_ms seq ");
  EXPECT_EQ(report(outcome)["edits"], 2);
  EXPECT_EQ(report(outcome)["seq"], 2);
  EXPECT_LE(report(outcome)["ack_p50_ms"], report(outcome)["ack_p99_ms"]);
}

TEST_F(Run, EndsWithOneWhenTheServerRefusesAnEdit) {
  const Outcome outcome = run(kEdit +
                              R"({"stencil":"circle","fill":true,"x":0,"y":0,"radius":600})"
                              "\n" +
                              kEdit);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(report(outcome)["acked"], 2);
  EXPECT_EQ(report(outcome)["rejected"], 1);
  EXPECT_EQ(outcome.err,
            "edit 2 refused: out_of_range: radius: 600 voxels is beyond the limit of 512\n");
}

TEST_F(Run, SendsNothingOfAScriptWithAMistake) {
  const Outcome outcome = run(kEdit + R"({"stencil":"heart","fill":true})"
                                      "\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("script.jsonl: line 2: stencil"), std::string::npos) << outcome.err;
  EXPECT_EQ(get(server_, "/api/maps").find("demo"), std::string::npos);
}

TEST_F(Run, NamesAMapThatIsNotThere) {
  const Outcome outcome = run(kEdit, {});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("answers 404"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

TEST_F(Run, UsesAMapOfEqualSettingsAndNoOther) {
  EXPECT_EQ(run(R"({"map":{"chunk_resolution":16}})"
                "\n" +
                kEdit)
                .exit_code,
            0);
  const Outcome again = run(R"({"map":{"chunk_resolution":16}})"
                            "\n" +
                            kEdit);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "warning: map demo is not new, its seq is 1\n");
  const Outcome other = run(R"({"map":{"chunk_resolution":8}})"
                            "\n" +
                            kEdit);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err, "map: there is a map demo with other settings already\n");
}

TEST_F(Run, KeepsToItsRateAndToTheScriptsWaits) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run(many(11), {"--create", "--rate", "50"}).exit_code, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 200ms);
  EXPECT_GE(report(run("{\"wait_ms\":150}\n" + kEdit))["seconds"].get<double>(), 0.15);
}

TEST_F(Run, PrintsItsFiguresWhenInterrupted) {
  auto all = arguments(many(10) + "{\"wait_ms\":60000}\n" + kEdit);
  all.push_back("--create");
  Program program("earthwork-bot", all);
  ASSERT_TRUE(wait_for_seq(server_, "demo", 10));
  program.signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(report(outcome)["edits"], 10);
  EXPECT_EQ(report(outcome)["acked"], 10);
  EXPECT_EQ(outcome.err, "interrupted\n");
}

TEST_F(Run, PrintsItsFiguresWhenTheServerGoesAway) {
  auto all = arguments(many(10) + "{\"wait_ms\":60000}\n" + kEdit);
  all.insert(all.end(), {"--create", "--patience", "1.5"});
  Program program("earthwork-bot", all);
  ASSERT_TRUE(wait_for_seq(server_, "demo", 10));
  server_.ask_to_end();
  EXPECT_EQ(server_.wait().exit_code, 0);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(report(outcome)["acked"], 10);
  EXPECT_EQ(outcome.err.find("the server ends; trying again\n"), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find("cannot be reached"), std::string::npos) << outcome.err;
}

TEST_F(Run, EndsWithOneWhenItsFiguresCannotBePrinted) {
  auto all = arguments(kEdit);
  all.push_back("--create");
  for (const Stdout missing : {Stdout::full, Stdout::closed}) {
    const std::vector<std::vector<std::string>> commands{
        all, {"watch", "--server", server_.url(), "--map", "demo"}, {"--help"}};
    for (const auto& arguments : commands) {
      const Outcome outcome = bot_without(missing, arguments);
      EXPECT_EQ(outcome.exit_code, 1) << arguments[0];
      EXPECT_NE(outcome.err.find("earthwork-bot: stdout cannot be written\n"), std::string::npos)
          << outcome.err;
    }
  }
}

TEST(Bot, NamesTheFlagWhoseValueIsWrong) {
  const std::vector<std::vector<std::string>> wrong{
      {"watch", "--until-seq", "-1"},
      {"watch", "--until-seq", "99999999999999999999"},
      {"watch", "--until-seq", "0x10"},
      {"watch", "--seconds", "nan"},
      {"watch", "--seconds", "-1"},
      {"run", "--rate", "nan", "x.jsonl"},
      {"run", "--rate", "inf", "x.jsonl"},
      {"run", "--window", "0x10", "x.jsonl"},
      {"run", "--patience", "-1", "x.jsonl"},
      {"trace", "--threshold", "257", "x.png"},
      {"trace", "--resolution", "0x10", "x.png"},
      {"trace", "--resolution", "9", "x.png"}};
  for (auto arguments : wrong) {
    const std::string flag = arguments[1];
    arguments.insert(arguments.end(), {"--map", "demo", "--server", "http://127.0.0.1:1"});
    const Outcome outcome = bot(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(outcome.err.starts_with("earthwork-bot: " + flag + ": ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST(Bot, EndsWithTwoAndOneLineWhenItIsUsedWrongly) {
  const std::vector<std::vector<std::string>> wrong{
      {},
      {"paint"},
      {"run"},
      {"run", "x.jsonl", "--map", "demo"},
      {"run", "x.jsonl", "--map", "demo", "--server", "http://127.0.0.1:1", "--window", "0"},
      {"run", "no-such-file", "--map", "demo", "--server", "http://127.0.0.1:1"},
      {"run", kConformance + "07_circles.jsonl", "--map", "demo", "--server", "here"},
      {"run", kConformance + "07_circles.jsonl", "--map", "demo", "--server", "http://127.0.0.1:1"},
      {"run", kConformance + "07_circles.jsonl", "--map", "../x", "--server", "http://127.0.0.1:1"},
      {"trace", "no-such-file.png", "--map", "demo", "--server", "http://127.0.0.1:1"},
      {"watch", "--map", "", "--server", "http://127.0.0.1:1"},
      {"watch", "--map", "demo", "--server", "http://127.0.0.1:1"}};
  for (const auto& arguments : wrong) {
    const Outcome outcome = bot(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST(Bot, HelpsAndTellsItsVersion) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"run", "--help"},
                                                    {"trace", "--help"},
                                                    {"watch", "--help"}}) {
    const Outcome outcome = bot(arguments);
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.out.find("Exit codes: 0 done"), std::string::npos);
    EXPECT_EQ(outcome.err, "");
  }
  const Outcome version = bot({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("earthwork-bot "));
  EXPECT_EQ(bot({"watch", "--version"}).out, version.out);
}

}  // namespace
}  // namespace earthwork::e2e
