#include <cstdio>

#include "tests/bench/figures.hpp"
#include "tests/bench/map_mesh.hpp"
#include "tests/bench/timing.hpp"

namespace earthwork::bench {

void bench_mesh(const Field& field, int threads, int reps) {
  const MapSize size = size_of(field);
  const voxel::Map map = make_map(field);
  MapMesh meshes(size);
  Report report{.tool = "earthwork, full re-mesh",
                .data = field.name,
                .threads = threads,
                .samples = time_each(reps, [&] { meshes.mesh_all(map, threads); }),
                .work = static_cast<double>(size.cells()),
                .unit = "cells",
                .figures = meshes.figures()};
  report.figures.emplace_back("map_bytes", static_cast<double>(map.memory_bytes()));
  report.figures.emplace_back("voxels", static_cast<double>(size.voxels()));
  std::puts(to_line(report).c_str());
}

}  // namespace earthwork::bench
