// earthwork-fanout: processor time of the server for each chunk record that it brings to a viewer,
// beside a plain epoll writer that sends ready messages of the same size, in the same run.
//
// The viewers live in this process and read everything; only the processes of the two servers are
// measured. Edits come in bursts, 20 a second: one edit that changes eight chunks, so that eight
// records wait together for every viewer; one that changes one; and eight edits in eight chunks,
// sent in a row. Rounds of all ways alternate.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <string_view>

#include "client/link/maps.hpp"
#include "tests/bench/fanout_crowd.hpp"
#include "tests/bench/fanout_plain.hpp"
#include "tests/bench/timing.hpp"

namespace {

using namespace earthwork;
using namespace earthwork::bench;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr const char* kUsage =
    "usage: earthwork-fanout VIEWERS SECONDS ROUNDS\n"
    "  VIEWERS 1 .. 4000, SECONDS of a round 1 .. 600, ROUNDS of each way 1 .. 100.\n"
    "One JSON line a figure on stdout; us_per_delivered: processor time of the server, in\n"
    "microseconds, for a record of record_bytes brought to a viewer, the median of the rounds.\n";

constexpr std::size_t kRecordBytes = 2048;
constexpr int kBurst = 8, kChunkSide = 32;
constexpr int kDiscRows = 3;
constexpr double kDiscStep = 6, kDiscRadius = 2.2;
constexpr auto kInterval = 50ms;  // 20 bursts a second
constexpr auto kQuiet = 300ms;

/// A disc on each place of a lattice in the middle of each of these chunks of the lowest row.
protocol::Edit discs(int first_chunk, int chunks, double shift, double radius, bool fill) {
  protocol::Edit edit;
  edit.fill = fill;
  edit.radius = radius;
  edit.is_path = true;
  for (int chunk = first_chunk; chunk < first_chunk + chunks; ++chunk)
    for (int row = 0; row < kDiscRows; ++row)
      for (int column = 0; column < kDiscRows; ++column)
        edit.path.push_back({.x = chunk * kChunkSide + kDiscStep * (column + 1) + shift,
                             .y = kDiscStep * (row + 1.0)});
  return edit;
}

/// Changes so many chunks, `chunks_an_edit` by each edit, and moves walls all over them: a bite is
/// taken from every disc, and at the next burst they are whole again. So what changed is about
/// kRecordBytes bytes, and not a small part of a record.
void paint_burst(CrowdEditor& editor, int chunks, int chunks_an_edit, int burst) {
  for (int chunk = 0; chunk < chunks; chunk += chunks_an_edit)
    editor.paint(burst % 2 == 0
                     ? discs(chunk, chunks_an_edit, kDiscRadius, kDiscRadius * 0.6, false)
                     : discs(chunk, chunks_an_edit, 0, kDiscRadius, true));
}

struct Round {
  double us_per_record = 0, us_per_message = 0, records_per_s = 0, groups_per_viewer_s = 0,
         records_per_group = 0, record_bytes = 0;
};

struct Way {
  const char* tool;
  const char* data;
  const ChildProcess& process;
  Crowd& crowd;
  std::function<void(int burst)> burst;
  std::vector<Round> rounds{};
};

double over(std::uint64_t value, double of) { return of > 0 ? static_cast<double>(value) / of : 0; }

Round run_round(Way& way, std::size_t viewers, int seconds) {
  way.crowd.drain_until_quiet(kQuiet);
  const StreamCounts before = way.crowd.counts();
  const double cpu_before = way.process.cpu_s();
  const auto start = Clock::now();
  const int bursts = static_cast<int>(seconds * (1000ms / kInterval));
  for (int burst = 0; burst < bursts; ++burst) {
    way.crowd.drain_for(start + burst * kInterval - Clock::now());
    way.burst(burst);
  }
  way.crowd.drain_until_quiet(kQuiet);
  const double wall_s = std::chrono::duration<double>(Clock::now() - start - kQuiet).count();
  const double cpu_us = (way.process.cpu_s() - cpu_before) * 1e6;
  const StreamCounts after = way.crowd.counts();
  const auto records = static_cast<double>(after.records - before.records);
  const auto groups = static_cast<double>(after.groups - before.groups);
  return {.us_per_record = records > 0 ? cpu_us / records : 0,
          .us_per_message = cpu_us / static_cast<double>(after.messages - before.messages),
          .records_per_s = records / wall_s,
          .groups_per_viewer_s = groups / wall_s / static_cast<double>(viewers),
          .records_per_group = groups > 0 ? records / groups : 0,
          .record_bytes = over(after.bytes - before.bytes, records)};
}

double median(const std::vector<Round>& rounds, double Round::*figure) {
  std::vector<double> values;
  for (const Round& round : rounds) values.push_back(round.*figure);
  return percentile(values, 0.5);
}

void print(const Way& way, std::size_t viewers, int seconds) {
  std::vector<double> costs;
  for (const Round& round : way.rounds) costs.push_back(round.us_per_record);
  const nlohmann::ordered_json line{
      {"tool", way.tool},
      {"data", way.data},
      {"viewers", viewers},
      {"seconds", seconds},
      {"rounds", way.rounds.size()},
      {"us_per_delivered", median(way.rounds, &Round::us_per_record)},
      {"us_per_delivered_min", percentile(costs, 1e-9)},
      {"us_per_delivered_max", percentile(costs, 1)},
      {"us_per_message", median(way.rounds, &Round::us_per_message)},
      {"delivered_per_s", median(way.rounds, &Round::records_per_s)},
      {"record_bytes", median(way.rounds, &Round::record_bytes)},
      {"groups_per_viewer_s", median(way.rounds, &Round::groups_per_viewer_s)},
      {"records_per_group", median(way.rounds, &Round::records_per_group)}};
  std::cout << line.dump() << std::endl;
}

void print_memory(const char* data, const BenchServer& server, std::uint64_t before,
                  std::size_t viewers) {
  const std::uint64_t now = server.process().memory_bytes();
  const double more = now > before ? static_cast<double>(now - before) : 0;
  const nlohmann::ordered_json line{{"tool", "earthwork"},
                                    {"data", data},
                                    {"viewers", viewers},
                                    {"memory_bytes", now},
                                    {"bytes_per_viewer", more / static_cast<double>(viewers)}};
  std::cout << line.dump() << std::endl;
}

void run(std::size_t viewers, int seconds, int rounds) {
  const PlainWriter writer(kRecordBytes);
  const BenchServer server;
  const link::ServerAddress address{.host = "127.0.0.1", .port = server.port()};
  if (const auto made = link::create_map(address, "bench", {}); !made)
    throw std::runtime_error(made.error().detail);

  Crowd crowd, plain_crowd;
  CrowdEditor editor(crowd, server.port());
  paint_burst(editor, kBurst, kBurst, 1);
  crowd.drain_until_quiet(kQuiet);
  const std::uint64_t memory = server.process().memory_bytes();
  for (std::size_t i = 0; i < viewers; ++i) {
    crowd.add(join_as_viewer(server.port()));
    plain_crowd.add(std::make_unique<CrowdSocket>(writer.port()));
  }
  print_memory("memory, all have joined", server, memory, viewers);

  const auto paint = [&editor](int chunks, int chunks_an_edit) {
    return [&editor, chunks, chunks_an_edit](int burst) {
      paint_burst(editor, chunks, chunks_an_edit, burst);
    };
  };
  const auto send = [&writer](Sending how) { return [&writer, how](int) { writer.send(how); }; };
  const ChildProcess &ours = server.process(), &theirs = writer.process();
  std::vector<Way> ways{
      {"earthwork", "8 records wait together", ours, crowd, paint(kBurst, kBurst)},
      {"epoll", "8 messages, one send each", theirs, plain_crowd, send(Sending::one_by_one)},
      {"earthwork", "1 record at a time", ours, crowd, paint(1, 1)},
      {"epoll", "8 messages, one send for all", theirs, plain_crowd, send(Sending::together)},
      {"earthwork", "8 edits at once", ours, crowd, paint(kBurst, 1)}};
  for (int i = 0; i < rounds; ++i)
    for (Way& way : ways) way.rounds.push_back(run_round(way, viewers, seconds));
  for (const Way& way : ways) print(way, viewers, seconds);
  print_memory("memory, after the rounds", server, memory, viewers);
}

// 0 when `text` is no number from 1 to `most`.
int parse_count(std::string_view text, int most) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && value >= 1 && value <= most ? value : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (first == "--help") return std::fputs(kUsage, stdout), 0;
  const int viewers = argc == 4 ? parse_count(argv[1], 4000) : 0;
  const int seconds = argc == 4 ? parse_count(argv[2], 600) : 0;
  const int rounds = argc == 4 ? parse_count(argv[3], 100) : 0;
  if (viewers == 0 || seconds == 0 || rounds == 0) return std::fputs(kUsage, stderr), 2;
  try {
    raise_file_limit();
    run(static_cast<std::size_t>(viewers), seconds, rounds);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthwork-fanout: %s\n", error.what());
    return 2;
  }
}
