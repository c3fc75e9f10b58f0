// What a load run is asked for, and what it tells.
#include "client/bot/load_command.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "client/bot/load_report.hpp"
#include "tests/link/fake_server.hpp"

namespace earthwork::bot {
namespace {

LoadOptions options() {
  LoadOptions out;
  out.editors = 2;
  out.viewers = 6;
  out.slow = 1;
  out.stalled = 2;
  out.flaky = 1;
  return out;
}

TEST(LoadPlan, HasItsBadViewersFirst) {
  const auto plan = plan_load(options(), {});
  ASSERT_TRUE(plan);
  std::vector<Manner> manners;
  for (std::size_t i = 0; i < 6; ++i) manners.push_back(manner_of(*plan, i));
  EXPECT_EQ(manners, (std::vector{Manner::slow, Manner::stalled, Manner::stalled, Manner::flaky,
                                  Manner::healthy, Manner::healthy}));
}

TEST(LoadPlan, RefusesMoreBadViewersThanThereAre) {
  LoadOptions all_bad = options();
  all_bad.viewers = 4;
  EXPECT_TRUE(plan_load(all_bad, {}));
  all_bad.viewers = 3;
  const auto plan = plan_load(all_bad, {});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().detail,
            "viewers: 3 are fewer than those slow, stalled and flaky together");
}

TEST(LoadPlan, RefusesCirclesThatTheMapWouldRefuse) {
  LoadOptions large = options();
  large.radius = 512;
  EXPECT_TRUE(plan_load(large, {}));
  large.radius = 513;
  const auto plan = plan_load(large, {});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().field, "radius");
}

TEST(LoadPlan, RefusesASquareThatNoViewHolds) {
  LoadOptions wide = options();
  wide.area = 4000;
  EXPECT_TRUE(plan_load(wide, {}));
  wide.area = 4096;  // and the circles' reach
  const auto plan = plan_load(wide, {});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().detail, "area: 16900 chunks are beyond the 16384 of a view");
  protocol::MapSettings bounded;
  bounded.chunks = {0, 0, 8, 8};
  EXPECT_EQ(plan_load(wide, bounded)->square.side, 256);
}

LoadReport good_report() {
  LoadReport report;
  report.seconds = 2;
  report.edits = report.acked = 100;
  report.frames = 5000;
  report.groups = 1000;
  report.records = 3000;
  report.bytes = 99'000;
  report.healthy_bytes = 60'000;
  report.healthy = {.viewers = 3, .agreeing = 3};
  report.slow = {.viewers = 1, .agreeing = 1};
  report.mesh_hash = 0xabc;
  report.seq = 100;
  report.painted = true;
  report.ack.add(std::chrono::milliseconds(2));
  return report;
}

TEST(LoadReport, IsDoneOnlyWhenAllAgreeAndEveryEditWasApplied) {
  EXPECT_EQ(exit_code(good_report()), kDone);
  const auto spoilt = [](auto spoil) {
    LoadReport report = good_report();
    spoil(report);
    return exit_code(report);
  };
  EXPECT_EQ(spoilt([](LoadReport& report) { report.healthy.agreeing = 2; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.slow.agreeing = 0; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.flaky.viewers = 1; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.stalled.viewers = 1; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.acked = 99; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.mesh_hash.reset(); }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.interrupted = true; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) { report.painted = false; }), kFailed);
  EXPECT_EQ(spoilt([](LoadReport& report) {
              report.failure = link::Closing{.cause = link::CloseCause::refused, .failure = {}};
            }),
            kUsage);
}

TEST(LoadReport, IsOneLineWithItsKeysInOrder) {
  LoadPlan plan;
  plan.editors = 2;
  plan.viewers = 4;
  const auto line = write_report(plan, good_report(), 321.5);
  std::string keys;
  for (const auto& [key, value] : line.items()) keys += key + " ";
  EXPECT_EQ(keys,
            "editors viewers seconds edits edits_per_s acked rejected frames frames_per_s "
            "groups_per_s records bytes bytes_per_edit_and_viewer voxel_bytes_per_edit ack_ms "
            "view_ms healthy slow stalled flaky reconnects mesh_hash seq generator ");
  EXPECT_EQ(line["edits_per_s"], 50.0);
  EXPECT_EQ(line["frames_per_s"], 2500.0);
  EXPECT_EQ(line["groups_per_s"], 500.0);
  EXPECT_EQ(line["bytes_per_edit_and_viewer"], 200.0);  // the healthy ones'
  EXPECT_EQ(line["voxel_bytes_per_edit"], 321.5);
  EXPECT_NEAR(line["ack_ms"]["p999"].get<double>(), 2, 0.01);
  EXPECT_EQ(line["view_ms"]["p50"], nullptr);  // nothing was sampled
  EXPECT_EQ(line["slow"], (nlohmann::ordered_json{{"viewers", 1}, {"agreeing", 1}}));
  EXPECT_EQ(line["mesh_hash"], "0000000000000abc");
}

TEST(LoadReport, HasNoFiguresOfNothing) {
  const auto line = write_report({}, {}, 0);
  for (const char* key : {"edits_per_s", "frames_per_s", "bytes_per_edit_and_viewer",
                          "voxel_bytes_per_edit", "mesh_hash"})
    EXPECT_EQ(line[key], nullptr) << key;
}

TEST(LoadReport, SaysWhenTheGeneratorWasTheLimit) {
  LoadReport report = good_report();
  report.busy = 0.8;
  report.lag.add(std::chrono::microseconds(990));
  EXPECT_FALSE(report.generator_limited());
  report.busy = 0.81;
  EXPECT_TRUE(report.generator_limited());
  report.busy = 0;
  for (int i = 0; i < 2; ++i) report.lag.add(std::chrono::milliseconds(2));
  EXPECT_TRUE(report.generator_limited());
}

TEST(LoadCommand, NamesAServerThatIsNotThere) {
  LoadOptions asked = options();
  asked.map = "demo";
  for (const std::string& server : {std::string("localhost"), link::nobody().text()}) {
    asked.server = server;
    std::ostringstream out, log;
    EXPECT_EQ(load_command(asked, out, log), kUsage);
    EXPECT_EQ(out.str(), "");
    EXPECT_NE(log.str(), "");
  }
}

}  // namespace
}  // namespace earthwork::bot
