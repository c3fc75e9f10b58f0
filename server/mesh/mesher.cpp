#include "server/mesh/mesher.hpp"

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/contour_graph.hpp"
#include "server/mesh/outline.hpp"
#include "server/mesh/triangulate.hpp"
#include "server/mesh/walls.hpp"

namespace earthwork::mesh {
namespace {

bool uniform_as(const voxel::Chunk* chunk, bool filled) {
  return chunk ? chunk->uniform() && chunk->filled(0, 0) == filled : !filled;
}

/// No voxel that the chunk's cells reach differs from its own, seen without looking at rows.
bool plainly_uniform(const voxel::Neighbourhood& chunks) {
  const bool filled = chunks.own && chunks.own->filled(0, 0);
  return uniform_as(chunks.own, filled) &&
         (!chunks.has_right || uniform_as(chunks.right, filled)) &&
         (!chunks.has_upper || uniform_as(chunks.upper, filled)) &&
         (!chunks.has_right || !chunks.has_upper || uniform_as(chunks.upper_right, filled));
}

void mesh_uniform(const voxel::Neighbourhood& chunks, int resolution, ChunkMesh& out) {
  if (!chunks.own || !chunks.own->filled(0, 0)) return;
  constexpr std::int32_t kStep = voxel::kEdgeSteps, kFirst = kStep / 2;
  const std::int32_t right = kFirst + (resolution - (chunks.has_right ? 0 : 1)) * kStep;
  const std::int32_t top = kFirst + (resolution - (chunks.has_upper ? 0 : 1)) * kStep;
  out.vertices = {{kFirst, kFirst}, {right, kFirst}, {kFirst, top}, {right, top}};
  out.triangles = {0, 1, 2, 2, 1, 3};
}

}  // namespace

struct Mesher::Scratch {
  std::int64_t limit = 0;
  ChunkCells cells;
  ContourGraph graph;
  WallTracer tracer;
  Triangulator triangulator;
  std::vector<std::uint16_t> next, number, ordered_next;

  void mesh_mixed(ChunkMesh& out);
  void number_points(std::vector<Point>& vertices);
  void cut_ground(ChunkMesh& out);
};

Mesher::Mesher(double max_feature_angle) : scratch_(std::make_unique<Scratch>()) {
  scratch_->limit = sharpness_limit(max_feature_angle);
}
Mesher::Mesher(Mesher&&) noexcept = default;
Mesher& Mesher::operator=(Mesher&&) noexcept = default;
Mesher::~Mesher() = default;

void Mesher::mesh(const voxel::Neighbourhood& chunks, int resolution, ChunkMesh& out) {
  out.clear();
  if (plainly_uniform(chunks)) {
    mesh_uniform(chunks, resolution, out);
    return;
  }
  scratch_->cells.assign(chunks, resolution);
  if (scratch_->cells.uniform()) {
    mesh_uniform(chunks, resolution, out);
  } else {
    scratch_->mesh_mixed(out);
  }
}

void Mesher::Scratch::mesh_mixed(ChunkMesh& out) {
  graph.build(cells, limit);
  tracer.trace(cells, graph, out.sections);
  link_outline(cells, graph, out.sections, next);
  number_points(out.vertices);
  for (Section& section : out.sections)
    section.a = number[section.a], section.b = number[section.b];
  cut_ground(out);
}

// Vertices are numbered in sweep order: the sweep then compares numbers, and neighbours in space
// are neighbours in the encoded mesh.
void Mesher::Scratch::number_points(std::vector<Point>& vertices) {
  number.resize(graph.points.size());
  for (const std::uint16_t point : graph.order) {
    if (tracer.dropped()[point]) continue;
    number[point] = static_cast<std::uint16_t>(vertices.size());
    vertices.push_back(graph.points[point]);
  }
}

void Mesher::Scratch::cut_ground(ChunkMesh& out) {
  ordered_next.resize(out.vertices.size());
  for (const std::uint16_t point : graph.order) {
    if (tracer.dropped()[point]) continue;
    ordered_next[number[point]] = next[point] == kNone ? kNone : number[next[point]];
  }
  triangulator.run(out.vertices, ordered_next, out.triangles);
  for (const ContourGraph::Ear& ear : graph.ears) {
    for (const std::uint16_t point : {ear.from, ear.tip, ear.to}) {
      out.triangles.push_back(number[point]);
    }
  }
}

}  // namespace earthwork::mesh
