// Connections that break at any byte: edits are neither lost nor done twice, and a viewer goes on
// with what it has.
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <random>

#include "tests/e2e/relay.hpp"
#include "tests/e2e/scripts.hpp"
#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

using nlohmann::json;

/// Cuts so many connections: each after a number of bytes drawn by lot, now and then before the
/// map is joined. The first one lives at least for `first` bytes.
Relay::Plan cutting(int cuts, std::size_t first, std::size_t least, std::size_t most) {
  return [=, random = std::mt19937(11)](int connection) mutable -> std::optional<std::size_t> {
    const auto between = [&](std::size_t low, std::size_t high) {
      return std::uniform_int_distribution<std::size_t>(low, high)(random);
    };
    if (connection >= cuts) return std::nullopt;
    if (connection == 0) return first + between(0, most);
    return connection % 6 == 5 ? between(1, least) : between(least, most);
  };
}

class Reconnect : public testing::Test {
 protected:
  std::string script(const std::string& text) {
    const std::string path = folder_ / ("script" + std::to_string(++scripts_) + ".jsonl");
    std::ofstream(path) << text;
    return path;
  }
  void paint(const std::string& text, const std::vector<std::string>& more) {
    std::vector<std::string> all{"run", script(text), "--server", server_->url()};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = bot(all);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  json info(const std::string& map) { return json::parse(get(*server_, "/api/maps/" + map)); }

  Folder folder_;
  std::unique_ptr<ServerProgram> server_ = std::make_unique<ServerProgram>();
  int scripts_ = 0;
};

TEST_F(Reconnect, PaintsThroughThirtyCutsWhatItPaintsWithoutThem) {
  const std::string edits = circles(1000, 60, 1);
  paint(edits, {"--map", "whole", "--create"});

  Relay relay(server_->address(), cutting(30, 5000, 3000, 8000));
  const Outcome outcome = bot({"run", script(edits), "--server", relay.url(), "--map", "cut",
                               "--create", "--window", "16"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(relay.cuts(), 30);
  EXPECT_EQ(report(outcome)["edits"], 1000);
  EXPECT_EQ(report(outcome)["acked"], 1000);
  EXPECT_EQ(report(outcome)["rejected"], 0);
  EXPECT_EQ(report(outcome)["seq"], 1000);
  EXPECT_EQ(info("cut")["seq"], 1000);
  EXPECT_EQ(info("cut")["hash"], info("whole")["hash"]);
  EXPECT_EQ(figures(*server_, "cut")["mesh_hash"], figures(*server_, "whole")["mesh_hash"]);
}

TEST_F(Reconnect, WatchesThroughCutsWithoutLoadingAllAgain) {
  paint(circles(3000, 400, 2), {"--map", "demo", "--create"});
  const auto load = figures(*server_, "demo")["mesh_bytes"].get<std::size_t>();

  Relay relay(server_->address(), cutting(20, load + 10'000, 4000, 40'000));
  Program watch("earthwork-bot",
                {"watch", "--server", relay.url(), "--map", "demo", "--until-seq", "3300"});
  ASSERT_TRUE(wait_for_users(*server_, "demo", 1));
  paint(circles(300, 20, 3), {"--map", "demo", "--rate", "40"});
  const Outcome outcome = watch.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const int cuts = relay.cuts();
  EXPECT_GE(cuts, 3) << outcome.err;
  EXPECT_EQ(report(outcome)["seq"], 3300);
  EXPECT_EQ(report(outcome)["mesh_hash"], figures(*server_, "demo")["mesh_hash"]);
  EXPECT_EQ(report(outcome)["chunks"], figures(*server_, "demo")["meshed_chunks"]);
  // Without its claims the last connection alone would have brought all of it a second time.
  const auto bytes = report(outcome)["bytes"].get<std::size_t>();
  EXPECT_LT(bytes, 2 * load) << cuts << " cuts";
}

TEST_F(Reconnect, EndsWithItsReportWhenTheMapIsGone) {
  Relay relay(server_->address(), [](int) { return std::nullopt; });
  Program run("earthwork-bot",
              {"run", script(circles(10, 60, 4) + "{\"wait_ms\":60000}\n" + circles(1, 60, 5)),
               "--server", relay.url(), "--map", "demo", "--create"});
  ASSERT_TRUE(wait_for_seq(*server_, "demo", 10));
  auto next = std::make_unique<ServerProgram>();
  relay.lead_to(next->address());
  server_ = std::move(next);  // the one before is asked to end
  const Outcome outcome = run.wait();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(report(outcome)["acked"], 10);
  EXPECT_EQ(outcome.err, "the server ends; trying again\nmap: there is no demo\n");
}

TEST_F(Reconnect, WatchesAMapOfTheSameNameThatWasMadeAnew) {
  paint(circles(50, 60, 6), {"--map", "demo", "--create"});
  Relay relay(server_->address(), [](int) { return std::nullopt; });
  Program watch("earthwork-bot",
                {"watch", "--server", relay.url(), "--map", "demo", "--until-seq", "70"});
  ASSERT_TRUE(wait_for_users(*server_, "demo", 1));
  auto before = std::move(server_);
  server_ = std::make_unique<ServerProgram>();
  paint(circles(70, 30, 7), {"--map", "demo", "--create"});
  relay.lead_to(server_->address());
  before.reset();
  const Outcome outcome = watch.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(report(outcome)["mesh_hash"], figures(*server_, "demo")["mesh_hash"]);
}

}  // namespace
}  // namespace earthwork::e2e
