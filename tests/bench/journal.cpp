// earthwork-journal: how fast a map file takes events beside what its disk can do at all, and how
// long 100,000 chunks take to be put and loaded.
#include <fcntl.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/history/fold.hpp"
#include "server/journal/map_file.hpp"

namespace {

using namespace earthwork;
using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kUsage =
    "usage: earthwork-journal FOLDER\n"
    "Works in FOLDER, which it makes and removes again, on the disk to be measured; one JSON line "
    "a\n"
    "figure on stdout.\n";

constexpr double kSeconds = 2;  // of each rate
constexpr int kChunksSide = 320;
constexpr std::size_t kChunks = 100'000, kChunksPerPut = 64;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class T>
T checked(protocol::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().detail);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

void print(const ordered_json& line) { std::cout << line.dump() << std::endl; }

/// Appends of 4 KiB to a plain file, each synced.
void measure_disk(const fs::path& folder) {
  const fs::path path = folder / "plain";
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  const std::string page(4096, 'x');
  std::size_t syncs = 0;
  const auto start = Clock::now();
  for (; seconds_since(start) < kSeconds; ++syncs)
    if (::write(file, page.data(), page.size()) != 4096 || ::fdatasync(file) != 0)
      throw std::runtime_error("the disk cannot be written to");
  const double seconds = seconds_since(start);
  ::close(file);
  print({{"figure", "fdatasync of 4 KiB"}, {"per_s", static_cast<double>(syncs) / seconds}});
}

history::Event event(std::uint64_t seq, std::mt19937_64& lot) {
  const auto coordinate = [&lot] { return static_cast<double>(lot() % 1'000'000) / 1000; };
  history::Event event{.seq = seq,
                       .time_ms = 1'700'000'000'000 + static_cast<std::int64_t>(seq),
                       .author = 0x1234'5678'9ABC'DEF0 + lot() % 8,
                       .id = static_cast<std::int64_t>(seq / 8 + 1),
                       .action = {},
                       .hash = lot()};
  protocol::Edit edit;
  edit.radius = 3;
  edit.path = {{coordinate(), coordinate()}};
  event.action = std::move(edit);
  return event;
}

void measure_appends(const fs::path& folder, std::size_t batch) {
  const fs::path path = folder / ("events" + std::to_string(batch) + ".earthwork");
  std::mt19937_64 lot(7);
  std::uint64_t seq = 0;
  std::vector<double> times_ms;
  double seconds = 0;
  {
    const auto journal = checked(journal::create_map_file(path, {}));
    std::vector<history::Event> events;
    const auto start = Clock::now();
    while ((seconds = seconds_since(start)) < kSeconds) {
      events.clear();
      while (events.size() < batch) events.push_back(event(seq + events.size() + 1, lot));
      const auto before = Clock::now();
      checked(journal->append(seq, events));
      times_ms.push_back(seconds_since(before) * 1000);
      seq += batch;
    }
  }
  std::sort(times_ms.begin(), times_ms.end());
  print({{"figure", "append"},
         {"batch", batch},
         {"events_per_s", static_cast<double>(seq) / seconds},
         {"commits_per_s", static_cast<double>(times_ms.size()) / seconds},
         {"commit_p50_ms", times_ms[times_ms.size() / 2]},
         {"commit_p99_ms", times_ms[times_ms.size() * 99 / 100]},
         {"bytes_per_event", static_cast<double>(fs::file_size(path)) / static_cast<double>(seq)}});
}

/// A field of circles, one or two in a chunk of 32 x 32.
std::vector<journal::ChunkState> some_chunks() {
  voxel::Map map = history::make_map({});
  std::mt19937_64 lot(11);
  std::vector<voxel::Stencil> circles;
  const auto within = [&lot](int chunk) {
    return chunk * 32 + static_cast<double>(lot() % 3200) / 100;
  };
  for (int y = 0; y < kChunksSide; ++y)
    for (int x = 0; x < kChunksSide; ++x) {
      voxel::Stencil circle;
      circle.shape = voxel::Shape::circle;
      circle.x = within(x), circle.y = within(y);
      circle.radius = 3 + static_cast<double>(lot() % 10);
      circles.push_back(circle);
    }
  map.apply(0, circles);
  std::vector<journal::ChunkState> states;
  for (const auto& key : map.keys()) states.push_back({key, 1, *map.find(key)});
  if (states.size() < kChunks) throw std::runtime_error("too few chunks were made");
  states.erase(states.begin() + kChunks, states.end());
  return states;
}

void measure_chunks(const fs::path& folder) {
  const fs::path path = folder / "chunks.earthwork";
  const auto states = some_chunks();
  std::mt19937_64 lot(7);
  double put_ms = 0, keyframe_ms = 0;
  {
    const auto journal = checked(journal::create_map_file(path, {}));
    checked(journal->append(0, std::vector{event(1, lot)}));
    auto start = Clock::now();
    for (std::size_t i = 0; i < states.size(); i += kChunksPerPut)
      checked(journal->put_chunks(
          std::span(states).subspan(i, std::min(kChunksPerPut, states.size() - i))));
    put_ms = seconds_since(start) * 1000;
    start = Clock::now();
    checked(journal->put_keyframe({.seq = 1}));
    keyframe_ms = seconds_since(start) * 1000;
  }
  const auto start = Clock::now();
  std::size_t told = 0;
  {
    const auto journal = checked(journal::open_map_file(path, journal::Access::write));
    checked(journal->chunks(1, [&told](const journal::ChunkState&) -> protocol::Result<void> {
      ++told;
      return {};
    }));
  }
  print(
      {{"figure", "chunks of 32 x 32"},
       {"chunks", told},
       {"put_ms", put_ms},
       {"chunks_per_put", kChunksPerPut},
       {"keyframe_ms", keyframe_ms},
       {"open_and_load_ms", seconds_since(start) * 1000},
       {"bytes_per_chunk", static_cast<double>(fs::file_size(path)) / static_cast<double>(told)}});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--help") return std::fputs(kUsage, stdout), 0;
  if (argc != 2) return std::fputs(kUsage, stderr), 2;
  const fs::path folder = argv[1];
  if (!fs::create_directory(folder)) return std::fputs(kUsage, stderr), 2;
  int status = 0;
  try {
    measure_disk(folder);
    for (const std::size_t batch : {1u, 8u, 64u}) measure_appends(folder, batch);
    measure_chunks(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthwork-journal: %s\n", error.what());
    status = 2;
  }
  fs::remove_all(folder);
  return status;
}
