// Layers from end to end: a script adds and changes them, a watcher sees them, a server that was
// killed has them again, and a recording of them proves itself.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using nlohmann::json;

// Two layers at first, four in the end; each new one is painted on by the very next line.
const char* const kScript = R"({"map":{"chunk_resolution":16,"layers":[{"name":"a"},{"name":"b"}]}}
{"stencil":"circle","fill":true,"x":4,"y":4,"radius":3}
{"kind":"layer","name":"roof","color":"#aa3322","wall":[2,2.5]}
{"stencil":"square","fill":true,"x":8,"y":8,"radius":3,"layer":2}
{"kind":"layer","layer":0,"name":"meadow"}
{"kind":"layer"}
{"stencil":"circle","fill":true,"x":20,"y":4,"radius":3,"layer":3}
{"kind":"layer","layer":2,"wall":[0,9]}
)";
constexpr int kSteps = 7;

class Layers : public testing::Test {
 protected:
  void serve() {
    server_.reset();
    server_ =
        std::make_unique<ServerProgram>(ServerProgram::Flags{.data = folder_ / "data", .more = {}});
  }
  Outcome run(const std::string& script, const std::string& map) {
    std::ofstream(folder_ / "script.jsonl") << script;
    return bot(
        {"run", folder_ / "script.jsonl", "--server", server_->url(), "--map", map, "--create"});
  }
  json description() const { return json::parse(get(*server_, "/api/maps/demo")); }
  /// The server does not run meanwhile.
  Outcome map(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "map");
    arguments.insert(arguments.end(), {"--data", folder_ / "data"});
    return Program("earthwork-server", arguments).wait();
  }

  Folder folder_;
  std::unique_ptr<ServerProgram> server_;
};

void expect_layers(const json& settings) {
  const json& layers = settings["layers"];
  ASSERT_EQ(layers.size(), 4u);
  EXPECT_EQ(layers[0]["name"], "meadow");
  EXPECT_EQ(layers[1]["name"], "b");
  EXPECT_EQ(layers[2], (json{{"name", "roof"}, {"color", "#aa3322"}, {"wall", {0.0, 9.0}}}));
  EXPECT_EQ(layers[3]["name"], "layer 4");
}

TEST_F(Layers, OfAScriptAreThereAfterAKillAndInAnExport) {
  serve();
  const Outcome ran = run(kScript, "demo");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  EXPECT_EQ(report(ran)["acked"], kSteps);
  const json before = description();
  EXPECT_EQ(before["seq"], kSteps);
  expect_layers(before["settings"]);
  const std::string exported = get(*server_, "/api/maps/demo/export.glb");

  server_->kill();
  serve();
  const json after = description();
  EXPECT_EQ(after["settings"], before["settings"]);
  EXPECT_EQ(after["hash"], before["hash"]);
  EXPECT_EQ(after["epoch"], before["epoch"]);
  EXPECT_TRUE(get(*server_, "/api/maps/demo/export.glb") == exported);
  EXPECT_GT(get(*server_, "/api/maps/demo/states.png?layer=3").size(), 50u);

  // Stopped in order this time: from a keyframe.
  server_->ask_to_end();
  ASSERT_EQ(server_->wait().exit_code, 0);
  serve();
  expect_layers(description()["settings"]);
}

TEST_F(Layers, AWatcherWritesThemAsTheServerExportsThem) {
  serve();
  Program watch("earthwork-bot",
                {"watch", "--server", server_->url(), "--map", "demo", "--until-seq",
                 std::to_string(kSteps), "--glb", folder_ / "watched.glb"});
  // There may be no map yet when it comes: then it is asked again after the script.
  ASSERT_EQ(run(kScript, "demo").exit_code, 0);
  if (watch.wait().exit_code != 0) {
    const Outcome again = bot({"watch", "--server", server_->url(), "--map", "demo", "--until-seq",
                               std::to_string(kSteps), "--glb", folder_ / "watched.glb"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
  }
  EXPECT_TRUE(read_file(folder_ / "watched.glb") == get(*server_, "/api/maps/demo/export.glb"));
}

TEST_F(Layers, AWatcherIsToldOfThoseThatComeWhileItWatches) {
  serve();
  ASSERT_EQ(run(R"({"stencil":"circle","fill":true,"x":4,"y":4,"radius":3})", "demo").exit_code, 0);
  Program watch("earthwork-bot", {"watch", "--server", server_->url(), "--map", "demo",
                                  "--until-seq", "3", "--glb", folder_ / "watched.glb"});
  ASSERT_TRUE(wait_for_users(*server_, "demo", 1));
  const Outcome ran = run(R"({"kind":"layer","name":"roof","color":"#aa3322","wall":[2,2.5]}
{"stencil":"square","fill":true,"x":8,"y":8,"radius":3,"layer":1})",
                          "demo");
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Outcome watched = watch.wait();
  ASSERT_EQ(watched.exit_code, 0) << watched.err;
  EXPECT_TRUE(read_file(folder_ / "watched.glb") == get(*server_, "/api/maps/demo/export.glb"));
}

TEST_F(Layers, OfARecordingAreProvedAndOfAnySeqShown) {
  serve();
  ASSERT_EQ(run(kScript, "demo").exit_code, 0);
  const json before = description();
  const std::string exported = get(*server_, "/api/maps/demo/export.glb");
  server_.reset();

  EXPECT_EQ(report(map({"verify", "demo"}))["sound"], true);
  const json info = report(map({"info", "demo"}));
  expect_layers(info["settings"]);
  EXPECT_EQ(info["hash"], before["hash"]);
  ASSERT_EQ(map({"export", "demo", folder_ / "demo.glb"}).exit_code, 0);
  EXPECT_TRUE(read_file(folder_ / "demo.glb") == exported);
  // As of the third event there was one layer more than at first, and no fourth.
  ASSERT_EQ(map({"export", "demo", folder_ / "third.png", "--seq", "3", "--layer", "2"}).exit_code,
            0);
  EXPECT_NE(map({"export", "demo", folder_ / "no.png", "--seq", "3", "--layer", "3"}).exit_code, 0);

  ASSERT_EQ(map({"export", "demo", folder_ / "demo.jsonl"}).exit_code, 0);
  const std::string recording = read_file(folder_ / "demo.jsonl");
  EXPECT_NE(recording.find(R"("kind":"layer","name":"roof")"), std::string::npos);
  const Outcome imported = map({"import", "again", folder_ / "demo.jsonl"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(report(imported)["hash"], before["hash"]);
  expect_layers(report(map({"info", "again"}))["settings"]);
  ASSERT_EQ(map({"fork", "again", "shorter", "--seq", "4"}).exit_code, 0);
  EXPECT_EQ(report(map({"info", "shorter"}))["settings"]["layers"].size(), 3u);
  EXPECT_EQ(report(map({"verify", "shorter"}))["sound"], true);

  // A recording is a script as well.
  serve();
  ASSERT_EQ(run(recording, "script").exit_code, 0);
  EXPECT_EQ(json::parse(get(*server_, "/api/maps/script"))["hash"], before["hash"]);
}

TEST_F(Layers, ThatAMapCannotHaveAreRefusedAndTheRestIsDone) {
  serve();
  const Outcome ran = run(R"({"kind":"layer","layer":3,"name":"x"}
{"stencil":"circle","fill":true,"x":4,"y":4,"radius":3,"layer":1}
{"stencil":"circle","fill":true,"x":4,"y":4,"radius":3})",
                          "demo");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(report(ran)["acked"], 1);
  EXPECT_EQ(ran.err,
            "edit 1 refused: out_of_range: layer: 3 of a map with 1 layers\n"
            "edit 2 refused: out_of_range: layer: 1 is outside 0 .. 0\n");
}

}  // namespace
}  // namespace earthwork::e2e
