#include "tests/render/drawn_map.hpp"

#include <stdexcept>
#include <utility>

namespace earthwork::viewer {
namespace {

voxel::Grid grid_of(const protocol::MapSettings& settings) {
  voxel::Grid grid;
  grid.resolution = settings.chunk_resolution;
  grid.voxel_size = settings.voxel_size;
  grid.layers = static_cast<int>(settings.layers.size());
  if (settings.chunks) {
    const auto& c = *settings.chunks;
    grid.bounds = voxel::ChunkRect{c[0], c[1], c[2], c[3]};
  }
  return grid;
}

protocol::ChunkRecord record_of(const voxel::ChunkKey& key, const mesh::ChunkMesh& mesh) {
  protocol::ChunkRecord record;
  record.key = {key.layer, key.x, key.y, key.z};
  record.revision = 1;
  record.removed = mesh.empty();
  for (const mesh::Point& p : mesh.vertices) record.mesh.vertices.push_back({p.x, p.y});
  record.mesh.triangles = mesh.triangles;
  for (const mesh::Section& s : mesh.sections)
    record.mesh.sections.push_back(
        {s.a, s.b, {s.normal_a.x, s.normal_a.y}, {s.normal_b.x, s.normal_b.y}});
  return record;
}

}  // namespace

DrawnMap::DrawnMap(const protocol::MapSettings& of)
    : settings(of), map_(grid_of(of)), mesher_(of.max_feature_angle) {
  scene_.join(1);
}

void DrawnMap::fill(const voxel::Stencil& stencil, int layer) {
  std::vector<protocol::FrameEvent> events;
  mesh::ChunkMesh mesh;
  for (const voxel::DirtyChunk& dirty : map_.apply(layer, {&stencil, 1}).dirty) {
    const voxel::ChunkKey& key = dirty.key;
    mesher_.mesh(map_.neighbourhood(key), settings.chunk_resolution, mesh);
    events.emplace_back(record_of(key, mesh));
    changed_.push_back({key.layer, key.x, key.y, key.z});
  }
  if (!scene_.take(events, 0)) throw std::logic_error("the scene refused a record");
}

std::vector<protocol::ChunkKey> DrawnMap::show(Renderer& renderer) {
  renderer.update(scene_.chunks(), changed_, settings);
  return std::exchange(changed_, {});
}

void DrawnMap::touch_all() {
  for (const auto& [key, chunk] : scene_.chunks()) changed_.push_back(key);
}

protocol::MapSettings one_layer(double bottom, double top,
                                std::optional<std::array<std::int32_t, 4>> chunks) {
  protocol::MapSettings settings;
  settings.chunks = chunks;
  settings.layers[0].bottom = bottom;
  settings.layers[0].top = top;
  return settings;
}

Picture look_at(const protocol::MapSettings& settings, const scene::Camera::Place& place,
                double width, double height) {
  Picture picture;
  picture.settings = settings;
  picture.camera.set_voxel_size(settings.voxel_size);
  picture.camera.resize({width, height});
  picture.camera.set(place);
  return picture;
}

}  // namespace earthwork::viewer
