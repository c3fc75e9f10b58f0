#include <array>
#include <chrono>
#include <cstdio>
#include <span>

#include "tests/bench/figures.hpp"
#include "tests/bench/map_mesh.hpp"
#include "tests/bench/timing.hpp"

namespace earthwork::bench {
namespace {

constexpr int kEdits = 2000;

enum class Step { apply, apply_and_mesh };

// The same places for every tool that measures this: a linear congruential generator's upper 24
// bits as a share of the map's side, in float; odd edits fill, even ones empty.
std::vector<voxel::Stencil> draw_edits(const MapSize& size, double radius) {
  std::uint32_t state = 12345;
  const auto draw = [&](int chunks) {
    state = state * 1664525u + 1013904223u;
    const float share = static_cast<float>(state >> 8) / 16777216.0f;
    return static_cast<double>(share * static_cast<float>(chunks * kBenchResolution));
  };
  std::vector<voxel::Stencil> edits;
  for (int k = 0; k < kEdits; ++k) {
    const double x = draw(size.chunks_x), y = draw(size.chunks_y);
    const auto fill = k % 2 == 1 ? voxel::Fill::filled : voxel::Fill::empty;
    edits.push_back({x, y, radius, voxel::Shape::circle, fill});
  }
  return edits;
}

// One pass over the edits; adds what each took to `each_us`. The clock is read once an edit.
void run_edits(voxel::Map& map, MapMesh& meshes, std::span<const voxel::Stencil> edits, Step step,
               std::vector<double>& each_us) {
  auto before = std::chrono::steady_clock::now();
  for (const voxel::Stencil& stencil : edits) {
    const voxel::Change& change = map.apply(0, {&stencil, 1});
    if (step == Step::apply_and_mesh) meshes.mesh_dirty(map, change);
    const auto now = std::chrono::steady_clock::now();
    each_us.push_back(std::chrono::duration<double, std::micro>(now - before).count());
    before = now;
  }
}

void bench_radius(const Field& field, int radius, Step step, int reps) {
  const MapSize size = size_of(field);
  const std::vector<voxel::Stencil> edits = draw_edits(size, radius);
  std::vector<double> each_us;
  each_us.reserve(edits.size() * static_cast<std::size_t>(reps));
  const bool only = step == Step::apply;
  Report report{.tool = std::string("earthwork, circle edit r=") + std::to_string(radius) +
                        (only ? ", applied" : ", applied and meshed"),
                .data = field.name,
                .threads = 1,
                .samples = {},
                .work = kEdits,
                .unit = "edits",
                .figures = {}};
  MapMesh meshes(size);
  for (int rep = 0; rep < reps; ++rep) {
    voxel::Map map = make_map(field);
    meshes.mesh_all(map, 1);
    report.samples.push_back(time_once([&] { run_edits(map, meshes, edits, step, each_us); }));
    if (rep + 1 < reps) continue;
    if (only) meshes.mesh_all(map, 1);
    report.figures = meshes.figures();
  }
  report.figures.emplace_back("p50_us", percentile(each_us, 0.5));
  report.figures.emplace_back("p99_us", percentile(each_us, 0.99));
  std::puts(to_line(report).c_str());
}

}  // namespace

void bench_edits(const Field& field, int reps) {
  for (const int radius : std::array{1, 5, 20}) {
    bench_radius(field, radius, Step::apply, reps);
    bench_radius(field, radius, Step::apply_and_mesh, reps);
  }
}

}  // namespace earthwork::bench
