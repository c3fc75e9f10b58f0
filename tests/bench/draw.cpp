// earthwork-draw: how many pictures a second the renderer draws off screen, and what a changed
// chunk costs. On a machine without a graphics card it is the processor that draws.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "client/viewer/render/offscreen.hpp"
#include "client/viewer/render/renderer.hpp"
#include "tests/render/drawn_map.hpp"

namespace {

using namespace earthwork;
using namespace earthwork::viewer;
using Clock = std::chrono::steady_clock;
using nlohmann::ordered_json;

constexpr const char* kUsage =
    "usage: earthwork-draw [TRIANGLES]...\n"
    "Draws maps of about so many triangles (100000 and 1000000 when none are named); one JSON line "
    "a\n"
    "figure on stdout.\n";

constexpr int kWidth = 1280, kHeight = 800;
constexpr double kSeconds = 3;  // of each figure
constexpr double kSpacing = 12, kRadius = 5;

/// Of all threads of this process: what a busy machine does not change much.
double cpu_ms() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <class T>
T checked(protocol::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().detail);
  return std::move(*result);
}

std::size_t triangles_of(const DrawnMap& map) {
  std::size_t count = 0;
  for (const auto& [key, chunk] : map.scene().chunks())
    count += chunk.mesh.triangles.size() / 3 + 2 * chunk.mesh.sections.size();
  return count;
}

/// A square of discs, `side` along each of its own.
void paint(DrawnMap& map, int side) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      map.circle((x + 0.5) * kSpacing, (y + 0.5) * kSpacing, kRadius + 0.1 * (x % 7));
}

/// How many discs a side make about so many triangles.
int side_for(std::size_t triangles) {
  DrawnMap sample(one_layer(-2, 0));
  paint(sample, 10);
  const double each = static_cast<double>(triangles_of(sample)) / 100;
  return std::max(1,
                  static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / each))));
}

double percentile(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class Bench {
 public:
  explicit Bench(int side)
      : offscreen_(checked(render::Offscreen::make(kWidth, kHeight))),
        renderer_(checked(Renderer::make())),
        map_(one_layer(-2, 0)),
        extent_(side * kSpacing) {
    paint(map_, side);
    map_.show(*renderer_);
  }

  /// All of the map, turning.
  void measure_pictures(double tilt) {
    std::vector<double> ms;
    DrawCounts counts;
    Picture picture = look_at(map_.settings, {{extent_ / 2, extent_ / 2}, 1}, kWidth, kHeight);
    picture.camera.fit({0, 0, extent_, extent_});
    picture.camera.orbit(0, tilt);
    const auto start = Clock::now();
    const double cpu_start = cpu_ms();
    while (ms_since(start) < 1000 * kSeconds) {
      picture.camera.orbit(0.01, 0);
      const auto begun = Clock::now();
      offscreen_->bind();
      counts = renderer_->draw(picture);
      offscreen_->finish();
      ms.push_back(ms_since(begun));
    }
    const double cpu = cpu_ms() - cpu_start;
    const double median = percentile(ms, 0.5);
    std::cout << ordered_json{{"figure", "pictures"},
                              {"width", kWidth},
                              {"height", kHeight},
                              {"tilt", tilt},
                              {"triangles", counts.triangles},
                              {"draws", counts.draws},
                              {"pictures", ms.size()},
                              {"ms_p50", median},
                              {"ms_p99", percentile(ms, 0.99)},
                              {"cpu_ms", cpu / static_cast<double>(ms.size())},
                              {"per_s", 1000 / median}}
                     .dump()
              << std::endl;
  }

  /// Chunks in the middle of the map, one at a time.
  void measure_updates() {
    std::vector<double> us;
    const auto start = Clock::now();
    for (int i = 0; ms_since(start) < 1000 * kSeconds; ++i) {
      const protocol::ChunkKey key{0, static_cast<int>(extent_ / 64), i % 4, 0};
      const auto begun = Clock::now();
      renderer_->update(map_.scene().chunks(), {&key, 1}, map_.settings);
      us.push_back(1000 * ms_since(begun));
      if (i % 64 == 0) offscreen_->finish();
    }
    std::cout << ordered_json{{"figure", "update"},
                              {"chunks", map_.scene().chunks().size()},
                              {"chunk_resolution", map_.settings.chunk_resolution},
                              {"us_p50", percentile(us, 0.5)},
                              {"us_p99", percentile(us, 0.99)}}
                     .dump()
              << std::endl;
  }

 private:
  std::unique_ptr<render::Offscreen> offscreen_;
  std::unique_ptr<Renderer> renderer_;  // goes before its context
  DrawnMap map_;
  double extent_;
};

void run(std::size_t triangles) {
  Bench bench(side_for(triangles));
  bench.measure_pictures(0);
  bench.measure_pictures(0.8);
  bench.measure_updates();
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) {
    const std::string_view text = argv[i];
    if (text == "--help") return std::fputs(kUsage, stdout) < 0 ? 1 : 0;
    const auto triangles = std::strtoull(argv[i], nullptr, 10);
    if (triangles < 1 || triangles > 20'000'000) {
      std::fprintf(stderr, "%s: triangles are 1 to 20000000\n%s", argv[i], kUsage);
      return 2;
    }
    sizes.push_back(triangles);
  }
  if (sizes.empty()) sizes = {100'000, 1'000'000};
  try {
    for (const std::size_t size : sizes) run(size);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthwork-draw: %s\n", error.what());
    return 1;
  }
  return 0;
}
