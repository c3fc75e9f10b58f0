// The page of metrics, read as Prometheus reads it.
#include "server/net/metrics.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace earthwork::net {
namespace {

/// One family: what its HELP and TYPE lines say, and its samples by their labels.
struct Family {
  std::string help, type;
  std::map<std::string, double> samples;
};

/// By the rules of the text format, 0.0.4: fails on every line that it does not allow, and on a
/// family whose lines do not stand together.
std::map<std::string, Family> read(const std::string& page) {
  std::map<std::string, Family> families;
  std::istringstream lines(page);
  std::string current;
  EXPECT_TRUE(page.ends_with('\n'));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, kind, name;
    words >> first;
    if (first == "#") {
      words >> kind >> name >> std::ws;
      std::string rest;
      std::getline(words, rest);
      EXPECT_FALSE(rest.empty()) << line;
      if (kind == "HELP") {
        EXPECT_FALSE(families.contains(name)) << line;
        families[name].help = rest;
      } else {
        EXPECT_EQ(kind, "TYPE") << line;
        families[name].type = rest;
      }
      current = name;
      continue;
    }
    const std::size_t labels = first.find('{');
    EXPECT_EQ(first.substr(0, labels), current) << line;
    double value = -1;
    words >> value;
    EXPECT_TRUE(words.eof() && !words.fail()) << line;
    const std::string label = labels == std::string::npos ? "" : first.substr(labels);
    EXPECT_TRUE(families[current].samples.emplace(label, value).second) << line;
  }
  return families;
}

MapTotals busy() {
  return {.maps = 8,
          .open_maps = 3,
          .viewers = 12,
          .waiting_edits = 7,
          .dirty_chunks = 40,
          .owed_chunks = 500,
          .oldest_wait_ms = 1250};
}

TEST(Metrics, SayWhatWasCounted) {
  room::Meters meters;
  meters.sessions = 5;
  meters.edits = 9'007'199'254'740'991;
  meters.repeated = 2;
  meters.chat_lines = 9;
  meters.meshed_chunks = 77;
  meters.mesh_ns = 2'500'000'000;
  meters.frames = 21;
  meters.frame_bytes = 22'000;
  meters.controls = 31;
  meters.control_bytes = 32'000;
  meters.commits = 41;
  meters.committed_events = 4'100;
  meters.commit_ns = 1'500'000'000;
  meters.waiting_events = 6;
  meters.keyframes = 43;
  auto page = read(metrics_text(meters, busy(), {.resident_bytes = 4096, .cpu_seconds = 0.25}));

  const std::map<std::string, double> expected{{"earthwork_sessions", 5},
                                               {"earthwork_maps", 8},
                                               {"earthwork_open_maps", 3},
                                               {"earthwork_viewers", 12},
                                               {"earthwork_edits_total", 9'007'199'254'740'991},
                                               {"earthwork_edits_repeated_total", 2},
                                               {"earthwork_chat_lines_total", 9},
                                               {"earthwork_dirty_chunks", 40},
                                               {"earthwork_meshed_chunks_total", 77},
                                               {"earthwork_mesh_seconds_total", 2.5},
                                               {"earthwork_frames_total", 21},
                                               {"earthwork_frame_bytes_total", 22'000},
                                               {"earthwork_controls_total", 31},
                                               {"earthwork_control_bytes_total", 32'000},
                                               {"earthwork_commits_total", 41},
                                               {"earthwork_committed_events_total", 4'100},
                                               {"earthwork_commit_seconds_total", 1.5},
                                               {"earthwork_waiting_events", 6},
                                               {"earthwork_keyframes_total", 43},
                                               {"earthwork_owed_chunks", 500},
                                               {"earthwork_waiting_edits", 7},
                                               {"earthwork_queue_age_seconds", 1.25},
                                               {"process_resident_memory_bytes", 4096},
                                               {"process_cpu_seconds_total", 0.25}};
  for (const auto& [name, value] : expected) EXPECT_EQ(page[name].samples[""], value) << name;
  EXPECT_EQ(page.size(), expected.size() + 2);  // and what was refused, what failed
}

TEST(Metrics, RefusalsAndFailuresHaveASampleForEveryCode) {
  room::Meters meters;
  for (std::size_t i = 0; i < meters.rejected.size(); ++i) {
    meters.rejected[i] = 100 + i;
    meters.journal_failures[i] = 300 + i;
  }
  auto page = read(metrics_text(meters, {}, {}));
  const auto check = [&](const char* name, double first) {
    auto& samples = page[name].samples;
    EXPECT_EQ(samples.size(), meters.rejected.size());
    const auto at = [&](protocol::Code code) { return first + static_cast<double>(code); };
    EXPECT_EQ(samples["{code=\"bad_json\"}"], at(protocol::Code::bad_json));
    EXPECT_EQ(samples["{code=\"disk_full\"}"], at(protocol::Code::disk_full));
    EXPECT_EQ(samples["{code=\"internal\"}"], at(protocol::Code::internal));
  };
  check("earthwork_rejected_total", 100);
  check("earthwork_journal_failures_total", 300);
}

TEST(Metrics, CountersAreNamedAsCountersAndEachHasItsHelp) {
  for (const auto& [name, family] : read(metrics_text({}, {}, {}))) {
    EXPECT_TRUE(family.type == "counter" || family.type == "gauge") << name;
    EXPECT_EQ(family.type == "counter", name.ends_with("_total")) << name;
    EXPECT_TRUE(family.help.ends_with('.')) << name;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(family.help[0]))) << name;
  }
}

TEST(Metrics, OfAProcessThatRunsAreAboveNothing) {
  const ProcessUsage usage = own_usage();
  EXPECT_GT(usage.resident_bytes, 1'000'000u);
  EXPECT_GT(usage.cpu_seconds, 0);
}

}  // namespace
}  // namespace earthwork::net
