#include "client/viewer/render/batch_mesh.hpp"

#include <limits>

namespace earthwork::viewer::render {
namespace {

constexpr float kVoxel = 1.0F / 32768;  // of a mesh's units; products with it are exact

std::int32_t floor_div(std::int32_t a, std::int32_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// Chunks along a batch's side.
std::int32_t side_chunks(int resolution) { return kBatchVoxels / resolution; }

/// Exact: 24 bits hold the sum.
BatchVertex vertex_at(const protocol::MeshPoint& at, float x, float y) {
  return {x + static_cast<float>(at.x) * kVoxel, y + static_cast<float>(at.y) * kVoxel, {}, 1, 0};
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

/// Writes into arrays that are large enough.
struct Writer {
  BatchVertex* vertices;
  std::uint32_t* next_index;
  std::uint32_t vertex_count = 0;

  void add_surface(const protocol::ChunkMesh& mesh, float x, float y) {
    const std::uint32_t base = vertex_count;
    for (const protocol::MeshPoint& at : mesh.vertices)
      vertices[vertex_count++] = vertex_at(at, x, y);
    for (const std::uint16_t index : mesh.triangles) *next_index++ = base + index;
  }

  /// Bottom, then top.
  std::uint32_t add_post(BatchVertex vertex, const protocol::MeshNormal& normal) {
    const std::uint32_t post = vertex_count;
    vertex.normal = normal;
    vertex.wall = 1;
    vertex.top = 0;
    vertices[vertex_count++] = vertex;
    vertex.top = 1;
    vertices[vertex_count++] = vertex;
    return post;
  }

  void add_walls(const protocol::ChunkMesh& mesh, float x, float y) {
    // Sections come in chains: where a smooth one goes on, the post between the two serves both.
    const protocol::WallSection* before = nullptr;
    std::uint32_t last_post = 0;
    for (const protocol::WallSection& section : mesh.sections) {
      const bool goes_on = before && before->b == section.a && before->normal_b == section.normal_a;
      const std::uint32_t a =
          goes_on ? last_post
                  : add_post(vertex_at(mesh.vertices[section.a], x, y), section.normal_a);
      const std::uint32_t b = add_post(vertex_at(mesh.vertices[section.b], x, y), section.normal_b);
      for (const std::uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) *next_index++ = corner;
      before = &section;
      last_post = b;
    }
  }
};

}  // namespace

BatchKey batch_of(const protocol::ChunkKey& chunk, int resolution) {
  const std::int32_t side = side_chunks(resolution);
  return {chunk.layer, floor_div(chunk.x, side), floor_div(chunk.y, side)};
}

void BatchMesh::rebuild(const scene::Scene::Chunks& chunks, const BatchKey& batch, int resolution) {
  std::size_t most_vertices = 0, all_indices = 0;
  for_each_chunk(chunks, batch, resolution, [&](int, int, const protocol::ChunkMesh& mesh) {
    most_vertices += mesh.vertices.size() + 4 * mesh.sections.size();
    all_indices += mesh.triangles.size() + 6 * mesh.sections.size();
  });
  vertices.resize(most_vertices);
  indices.resize(all_indices);
  Writer writer{vertices.data(), indices.data()};
  for_each_chunk(chunks, batch, resolution, [&](int x, int y, const protocol::ChunkMesh& mesh) {
    writer.add_surface(mesh, static_cast<float>(x), static_cast<float>(y));
  });
  for_each_chunk(chunks, batch, resolution, [&](int x, int y, const protocol::ChunkMesh& mesh) {
    writer.add_walls(mesh, static_cast<float>(x), static_cast<float>(y));
  });
  vertices.resize(writer.vertex_count);
}

}  // namespace earthwork::viewer::render
