#include "client/viewer/render/batch_mesh.hpp"

#include <limits>

namespace earthwork::viewer::render {
namespace {

constexpr double kUnitsPerVoxel = 32768;

std::int32_t floor_div(std::int32_t a, std::int32_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// Chunks along a batch's side.
std::int32_t side_chunks(int resolution) { return kBatchVoxels / resolution; }

BatchVertex vertex_at(const protocol::MeshPoint& at, double x, double y) {
  BatchVertex vertex;
  vertex.x = static_cast<float>(x + at.x / kUnitsPerVoxel);
  vertex.y = static_cast<float>(y + at.y / kUnitsPerVoxel);
  vertex.top = 1;
  return vertex;
}

/// Calls `visit(x, y, mesh)` for the batch's chunks that have one; x, y in voxels from its corner.
template <class Visit>
void for_each_chunk(const scene::Scene::Chunks& chunks, const BatchKey& batch, int resolution,
                    const Visit& visit) {
  const std::int32_t side = side_chunks(resolution);
  const std::int32_t x0 = batch.x * side, y0 = batch.y * side;
  for (std::int32_t cx = x0; cx < x0 + side; ++cx) {
    const protocol::ChunkKey first{batch.layer, cx, y0, std::numeric_limits<std::int32_t>::min()};
    for (auto it = chunks.lower_bound(first); it != chunks.end(); ++it) {
      const protocol::ChunkKey& key = it->first;
      if (key.layer != batch.layer || key.x != cx || key.y >= y0 + side) break;
      visit((cx - x0) * resolution, (key.y - y0) * resolution, it->second.mesh);
    }
  }
}

}  // namespace

BatchKey batch_of(const protocol::ChunkKey& chunk, int resolution) {
  const std::int32_t side = side_chunks(resolution);
  return {chunk.layer, floor_div(chunk.x, side), floor_div(chunk.y, side)};
}

void BatchMesh::rebuild(const scene::Scene::Chunks& chunks, const BatchKey& batch, int resolution) {
  vertices.clear();
  indices.clear();
  for_each_chunk(chunks, batch, resolution,
                 [&](int x, int y, const protocol::ChunkMesh& mesh) { add_surface(mesh, x, y); });
  for_each_chunk(chunks, batch, resolution,
                 [&](int x, int y, const protocol::ChunkMesh& mesh) { add_walls(mesh, x, y); });
}

void BatchMesh::add_surface(const protocol::ChunkMesh& mesh, double x, double y) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  for (const protocol::MeshPoint& at : mesh.vertices) vertices.push_back(vertex_at(at, x, y));
  for (const std::uint16_t index : mesh.triangles) indices.push_back(base + index);
}

std::uint32_t BatchMesh::add_post(const protocol::MeshPoint& at, const protocol::MeshNormal& normal,
                                  double x, double y) {
  BatchVertex vertex = vertex_at(at, x, y);
  vertex.normal = normal;
  vertex.wall = 1;
  const auto post = static_cast<std::uint32_t>(vertices.size());
  vertex.top = 0;
  vertices.push_back(vertex);
  vertex.top = 1;
  vertices.push_back(vertex);
  return post;
}

void BatchMesh::add_walls(const protocol::ChunkMesh& mesh, double x, double y) {
  // Sections come in chains: where a smooth one goes on, the post between the two serves both.
  const protocol::WallSection* before = nullptr;
  std::uint32_t last_post = 0;
  for (const protocol::WallSection& section : mesh.sections) {
    const bool goes_on = before && before->b == section.a && before->normal_b == section.normal_a;
    const std::uint32_t a =
        goes_on ? last_post : add_post(mesh.vertices[section.a], section.normal_a, x, y);
    const std::uint32_t b = add_post(mesh.vertices[section.b], section.normal_b, x, y);
    for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) indices.push_back(corner);
    before = &section;
    last_post = b;
  }
}

}  // namespace earthwork::viewer::render
