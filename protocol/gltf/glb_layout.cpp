#include "protocol/gltf/glb_layout.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/gltf/wall_strip.hpp"

namespace earthwork::protocol {
namespace {

constexpr double kStepsPerVoxel = 32768;

std::size_t aligned(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

/// Grows around points; their order of size is that of the float32 positions, so only corners
/// need to be converted.
class Extent {
 public:
  void include(MeshPoint point) {
    low_ = {std::min(low_.x, point.x), std::min(low_.y, point.y)};
    high_ = {std::max(high_.x, point.x), std::max(high_.y, point.y)};
  }
  void write(double bottom, double top, double voxel_size, PrimitiveLayout& layout) const {
    layout.min = glb_position({low_.x, high_.y}, bottom, voxel_size);
    layout.max = glb_position({high_.x, low_.y}, top, voxel_size);
  }

 private:
  MeshPoint low_{INT32_MAX, INT32_MAX}, high_{INT32_MIN, INT32_MIN};
};

PrimitiveLayout placed(std::size_t vertices, std::size_t indices, std::size_t offset) {
  PrimitiveLayout layout{.vertices = vertices, .indices = indices, .vertex_offset = offset};
  layout.index_offset = offset + vertices * kGlbVertexBytes;
  return layout;
}

PrimitiveLayout surface_layout(const ChunkMesh& mesh, const LayerSettings& layer, double voxel_size,
                               std::size_t offset) {
  PrimitiveLayout layout = placed(mesh.vertices.size(), mesh.triangles.size(), offset);
  Extent extent;
  for (const MeshPoint& vertex : mesh.vertices) extent.include(vertex);
  extent.write(layer.top, layer.top, voxel_size, layout);
  return layout;
}

PrimitiveLayout wall_layout(const ChunkMesh& mesh, const LayerSettings& layer, double voxel_size,
                            std::size_t offset) {
  const WallStrip strip = wall_strip(mesh);
  PrimitiveLayout layout = placed(strip.posts.size() * 2, strip.panels.size() * 6, offset);
  Extent extent;
  for (const WallPost& post : strip.posts) extent.include(mesh.vertices[post.vertex]);
  extent.write(layer.bottom, layer.top, voxel_size, layout);
  return layout;
}

}  // namespace

GlbLayout glb_layout(const MapSettings& settings, const MeshMap& meshes) {
  GlbLayout layout;
  for (const auto& [key, mesh] : meshes) {
    if (mesh->triangles.empty() && mesh->sections.empty()) continue;
    const LayerSettings& layer = settings.layers.at(static_cast<std::size_t>(key.layer));
    ChunkLayout chunk{.key = key, .mesh = mesh, .surface = {}, .wall = {}};
    if (!mesh->triangles.empty()) {
      chunk.surface = surface_layout(*mesh, layer, settings.voxel_size, layout.bytes);
      layout.bytes = aligned(chunk.surface->end());
    }
    if (!mesh->sections.empty()) {
      chunk.wall = wall_layout(*mesh, layer, settings.voxel_size, layout.bytes);
      layout.bytes = aligned(chunk.wall->end());
    }
    layout.chunks.push_back(chunk);
  }
  return layout;
}

Float3 glb_position(MeshPoint point, double height, double voxel_size) {
  const double x = point.x / kStepsPerVoxel * voxel_size, y = point.y / kStepsPerVoxel * voxel_size;
  // 0 - y rather than -y: there is no negative zero in the file.
  return {static_cast<float>(x), static_cast<float>(height), static_cast<float>(0 - y)};
}

Float3 glb_normal(MeshNormal normal) {
  const double x = normal.x, y = normal.y, length = std::sqrt(x * x + y * y);
  return {static_cast<float>(x / length), 0, static_cast<float>(0 - y / length)};
}

}  // namespace earthwork::protocol
