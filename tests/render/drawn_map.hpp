// A map that is painted here and seen as a viewer sees it: its meshes are made as the server makes
// them, and come as chunk records.
#pragma once

#include <optional>
#include <vector>

#include "client/scene/scene.hpp"
#include "client/viewer/picture.hpp"
#include "client/viewer/render/renderer.hpp"
#include "server/mesh/mesher.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::viewer {

class DrawnMap {
 public:
  explicit DrawnMap(const protocol::MapSettings& settings);

  void fill(const voxel::Stencil& stencil, int layer = 0);
  void circle(double x, double y, double radius, int layer = 0) {
    fill({x, y, radius, voxel::Shape::circle, voxel::Fill::filled}, layer);
  }
  void square(double x, double y, double radius, int layer = 0) {
    fill({x, y, radius, voxel::Shape::square, voxel::Fill::filled}, layer);
  }
  void dig(double x, double y, double radius, int layer = 0) {
    fill({x, y, radius, voxel::Shape::circle, voxel::Fill::empty}, layer);
  }

  /// Hands the renderer what has changed since the last time, and gives it back.
  std::vector<protocol::ChunkKey> show(Renderer& renderer);

  /// All of it counts as changed.
  void touch_all();

  const scene::Scene& scene() const { return scene_; }
  protocol::MapSettings settings;

 private:
  voxel::Map map_;
  mesh::Mesher mesher_;
  scene::Scene scene_;
  std::vector<protocol::ChunkKey> changed_;
};

/// Settings of a map of one layer between these heights, of `chunks` around its middle or none.
protocol::MapSettings one_layer(double bottom, double top,
                                std::optional<std::array<std::int32_t, 4>> chunks = {});

/// A picture of a map, `width` x `height` CSS pixels.
Picture look_at(const protocol::MapSettings& settings, const scene::Camera::Place& place,
                double width, double height);

}  // namespace earthwork::viewer
