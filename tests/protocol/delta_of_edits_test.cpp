// Deltas of real edits: crowded ground, circle after circle, every mesh as the mesher makes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>

#include "protocol/record_delta.hpp"
#include "server/mesh/mesher.hpp"
#include "server/voxel/map.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

using voxel::Stencil;

ChunkMesh to_protocol(const mesh::ChunkMesh& mesh) {
  ChunkMesh out{.vertices = {}, .triangles = mesh.triangles, .sections = {}};
  for (const auto& p : mesh.vertices) out.vertices.push_back({p.x, p.y});
  for (const auto& s : mesh.sections)
    out.sections.push_back({s.a, s.b, {s.normal_a.x, s.normal_a.y}, {s.normal_b.x, s.normal_b.y}});
  return out;
}

/// What a voxel server would have to send: a bit for each voxel of which the state changed, six
/// bytes for each crossing.
std::size_t changed_voxel_bytes(const voxel::Chunk* before, const voxel::Chunk* after, int side) {
  std::size_t voxels = 0, crossings = 0;
  const voxel::Chunk nothing(side);
  if (!before) before = &nothing;
  if (!after) after = &nothing;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) voxels += before->filled(x, y) != after->filled(x, y);
    for (const auto axis : {voxel::Axis::x, voxel::Axis::y})
      for (const auto& crossing : after->crossings(axis, y)) {
        const auto old = before->crossings(axis, y);
        crossings += std::find(old.begin(), old.end(), crossing) == old.end();
      }
  }
  return (voxels + 7) / 8 + 6 * crossings;
}

std::size_t voxel_bytes(const voxel::Chunk* chunk, int side) {
  const auto cells = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  return cells / 8 + (chunk ? 6 * static_cast<std::size_t>(chunk->crossing_count()) : 0);
}

/// What an edit costs, its changed chunks added up.
struct Cost {
  std::size_t full = 0, delta = 0, changed_voxels = 0, voxels = 0;
};

/// A map of 128 x 128 voxels and the records of its chunks.
class Ground {
 public:
  Ground(int resolution, std::uint32_t seed) : grid_(grid(resolution)), map_(grid_), random_(seed) {
    for (int i = 0; i < 1500; ++i) stamp(random_() % 2 == 0);
    for (const auto& key : map_.meshed_keys()) records_[key] = record(key, 1);
    keep_voxels();
  }

  /// Stamps a circle, and expects each changed chunk's delta to give its very record.
  Cost edit(std::uint64_t revision) {
    Cost cost;
    const voxel::Change change = stamp(revision % 2 == 0);
    for (const auto& dirty : change.dirty) {
      const ChunkRecord next = record(dirty.key, revision);
      ChunkRecord& base = records_[dirty.key];
      if (next.mesh == base.mesh) continue;
      count(base, next, cost);
      const voxel::Chunk* chunk = map_.find(dirty.key);
      cost.voxels += voxel_bytes(chunk, grid_.resolution);
      base = next;
    }
    for (const auto& key : change.changed) {
      const voxel::Map& old = before_;
      cost.changed_voxels += changed_voxel_bytes(old.find(key), map_.find(key), grid_.resolution);
    }
    before_.apply(0, {&last_, 1});
    return cost;
  }

 private:
  static voxel::Grid grid(int resolution) {
    voxel::Grid grid;
    grid.resolution = resolution;
    grid.bounds = voxel::ChunkRect{0, 0, 128 / resolution, 128 / resolution};
    return grid;
  }

  double draw() { return static_cast<double>(random_() >> 8) / 16777216.0 * 128; }

  const voxel::Change& stamp(bool fill) {
    last_ = {draw(), draw(), 3, voxel::Shape::circle,
             fill ? voxel::Fill::filled : voxel::Fill::empty};
    stamps_.push_back(last_);
    return map_.apply(0, {&last_, 1});
  }

  void keep_voxels() { before_.apply(0, stamps_); }

  ChunkRecord record(const voxel::ChunkKey& key, std::uint64_t revision) {
    mesher_.mesh(map_.neighbourhood(key), grid_.resolution, scratch_);
    return {.key = {key.layer, key.x, key.y, key.z},
            .revision = revision,
            .removed = false,
            .mesh = to_protocol(scratch_)};
  }

  static void count(const ChunkRecord& base, const ChunkRecord& next, Cost& cost) {
    const std::string full = encoded(next);
    std::string bytes;
    const bool is_delta = encode_delta(base, next, full.size(), bytes);
    cost.full += full.size();
    cost.delta += is_delta ? bytes.size() : full.size();
    if (!is_delta) return;
    const auto delta = decode_delta(bytes_of(bytes));
    ASSERT_TRUE(delta);
    const auto applied = apply_delta(base.mesh, *delta);
    ASSERT_TRUE(applied) << applied.error().detail;
    ASSERT_EQ(encoded(*applied), full);
  }

  voxel::Grid grid_;
  voxel::Map map_, before_{grid_};
  std::mt19937 random_;
  Stencil last_;
  std::vector<Stencil> stamps_;
  mesh::Mesher mesher_{135};
  mesh::ChunkMesh scratch_;
  std::map<voxel::ChunkKey, ChunkRecord> records_;
};

std::size_t median(std::vector<Cost> costs, std::size_t Cost::*column) {
  const auto middle = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2);
  std::nth_element(costs.begin(), middle, costs.end(),
                   [&](const Cost& a, const Cost& b) { return a.*column < b.*column; });
  return (*middle).*column;
}

TEST(DeltaOfEdits, GivesTheVeryRecordInAFewBytes) {
  Ground ground(32, 7);
  std::vector<Cost> costs;
  for (std::uint64_t i = 2; i < 1002 && !HasFatalFailure(); ++i) {
    const Cost cost = ground.edit(i);
    if (cost.full > 0) costs.push_back(cost);
  }
  ASSERT_GT(costs.size(), 900u);
  std::printf(
      "an edit, median bytes: %zu as deltas, %zu as full records, %zu of changed voxels, "
      "%zu of its chunks' voxels\n",
      median(costs, &Cost::delta), median(costs, &Cost::full), median(costs, &Cost::changed_voxels),
      median(costs, &Cost::voxels));
  EXPECT_LT(median(costs, &Cost::delta), 200u);
  EXPECT_GT(median(costs, &Cost::full), 3000u);
}

TEST(DeltaOfEdits, HoldsAtEveryResolution) {
  for (const int resolution : {8, 16, 64}) {
    Ground ground(resolution, 11);
    for (std::uint64_t i = 2; i < 152 && !HasFatalFailure(); ++i) ground.edit(i);
  }
}

}  // namespace
}  // namespace earthwork::protocol
