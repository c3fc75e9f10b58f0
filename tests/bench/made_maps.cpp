#include "tests/bench/made_maps.hpp"

#include "server/mesh/mesher.hpp"

namespace earthwork::bench {
namespace {

using voxel::Fill;
using voxel::Shape;
using voxel::Stencil;

void add_circle(voxel::Map& map, double x, double y, double radius, Fill fill) {
  const Stencil stencil{x, y, radius, Shape::circle, fill};
  map.apply(0, {&stencil, 1});
}

void add_rings(voxel::Map& map) {
  for (const double y : {32.0, 96.0}) {
    for (const double x : {32.0, 96.0}) {
      add_circle(map, x, y, 28, Fill::filled);
      add_circle(map, x, y, 18, Fill::empty);
    }
  }
}

void add_noise(voxel::Map& map) {
  std::uint32_t state = 1;
  const auto draw = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / 16777216.0;
  };
  for (int i = 0; i < 2000; ++i) {
    const double x = draw() * 128, y = draw() * 128, radius = 1 + 2 * draw();
    add_circle(map, x, y, radius, i % 2 == 0 ? Fill::filled : Fill::empty);
  }
}

}  // namespace

voxel::Map make_ground(Ground ground) {
  voxel::Grid grid;
  grid.resolution = 64;
  grid.bounds = voxel::ChunkRect{0, 0, 2, 2};
  voxel::Map map(grid);
  if (ground == Ground::full) add_circle(map, 64, 64, 128, Fill::filled);
  if (ground == Ground::ring) add_rings(map);
  if (ground == Ground::noise) add_noise(map);
  return map;
}

protocol::ChunkRecord make_record(Ground ground) {
  const voxel::Map map = make_ground(ground);
  mesh::Mesher mesher(135);
  mesh::ChunkMesh mesh;
  mesher.mesh(map.neighbourhood({}), 64, mesh);
  protocol::ChunkRecord record;
  record.revision = 1;
  for (const auto& p : mesh.vertices) record.mesh.vertices.push_back({p.x, p.y});
  record.mesh.triangles = mesh.triangles;
  for (const auto& s : mesh.sections) {
    record.mesh.sections.push_back(
        {s.a, s.b, {s.normal_a.x, s.normal_a.y}, {s.normal_b.x, s.normal_b.y}});
  }
  return record;
}

}  // namespace earthwork::bench
