// Micro-benchmarks of what an edit goes through: applied, hashed, meshed, encoded, decoded.
#include <benchmark/benchmark.h>

#include "server/mesh/mesher.hpp"
#include "tests/bench/made_maps.hpp"

namespace earthwork::bench {
namespace {

// Fills and empties the same circle, so that every call changes voxels.
void apply_circle(benchmark::State& state) {
  voxel::Map map = make_ground(Ground::noise);
  voxel::Stencil stencil{61.3, 62.7, static_cast<double>(state.range(0)), voxel::Shape::circle,
                         voxel::Fill::filled};
  for (auto _ : state) {
    benchmark::DoNotOptimize(&map.apply(0, {&stencil, 1}));
    stencil.fill = stencil.fill == voxel::Fill::filled ? voxel::Fill::empty : voxel::Fill::filled;
  }
}
BENCHMARK(apply_circle)->Arg(1)->Arg(5)->Arg(20);

void mesh_chunk(benchmark::State& state, Ground ground) {
  const voxel::Map map = make_ground(ground);
  mesh::Mesher mesher(135);
  mesh::ChunkMesh mesh;
  for (auto _ : state) {
    mesher.mesh(map.neighbourhood({}), 64, mesh);
    benchmark::DoNotOptimize(mesh.vertices.data());
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size()) / 3;
}
BENCHMARK_CAPTURE(mesh_chunk, empty, Ground::empty);
BENCHMARK_CAPTURE(mesh_chunk, full, Ground::full);
BENCHMARK_CAPTURE(mesh_chunk, ring, Ground::ring);
BENCHMARK_CAPTURE(mesh_chunk, noise, Ground::noise);

void hash_chunk(benchmark::State& state, Ground ground) {
  const voxel::Map map = make_ground(ground);
  for (auto _ : state) benchmark::DoNotOptimize(map.find({})->hash());
}
BENCHMARK_CAPTURE(hash_chunk, ring, Ground::ring);
BENCHMARK_CAPTURE(hash_chunk, noise, Ground::noise);

void hash_mesh(benchmark::State& state, Ground ground) {
  const protocol::ChunkRecord record = make_record(ground);
  for (auto _ : state) benchmark::DoNotOptimize(protocol::mesh_hash(record.mesh));
}
BENCHMARK_CAPTURE(hash_mesh, ring, Ground::ring);
BENCHMARK_CAPTURE(hash_mesh, noise, Ground::noise);

void encode_chunk(benchmark::State& state, Ground ground) {
  const protocol::ChunkRecord record = make_record(ground);
  std::string bytes;
  for (auto _ : state) {
    bytes.clear();
    protocol::encode_record(record, bytes);
    benchmark::DoNotOptimize(bytes.data());
  }
  state.counters["bytes"] = static_cast<double>(bytes.size());
}
BENCHMARK_CAPTURE(encode_chunk, ring, Ground::ring);
BENCHMARK_CAPTURE(encode_chunk, noise, Ground::noise);

void decode_chunk(benchmark::State& state, Ground ground) {
  std::string bytes;
  protocol::encode_record(make_record(ground), bytes);
  const auto view = std::as_bytes(std::span(bytes));
  for (auto _ : state) {
    if (!protocol::decode_record(view)) state.SkipWithError("what was encoded is refused");
  }
}
BENCHMARK_CAPTURE(decode_chunk, ring, Ground::ring);
BENCHMARK_CAPTURE(decode_chunk, noise, Ground::noise);

}  // namespace
}  // namespace earthwork::bench
