/// What one picture shows, apart from the meshes: enough to draw it again anywhere.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "client/scene/camera.hpp"
#include "protocol/edit.hpp"
#include "protocol/limits.hpp"
#include "protocol/settings.hpp"

namespace earthwork::viewer {

/// sRGB and opacity, 0 .. 1 each.
using Color = std::array<float, 4>;

/// "#rrggbb"; grey for anything else.
[[nodiscard]] Color color_of(std::string_view hash_rrggbb, float opacity = 1);

/// A line on the map, drawn over all else, as wide at any distance.
struct Outline {
  std::vector<protocol::MapPoint> points;  ///< Map units.
  bool closed = true;
  double height = 0;  ///< Where it lies; map units.
  Color color{};
  double width = 2;  ///< CSS pixels.
};

struct Picture {
  scene::Camera camera;
  double pixel_ratio = 1;  ///< Pixels of the picture to one of the camera's.
  protocol::MapSettings settings;
  std::bitset<protocol::kMaxLayers> hidden;  ///< Layers that are not drawn.
  std::uint32_t dots_layer = 0;              ///< Voxel dots lie on top of this one.
  std::vector<Outline> outlines;             ///< Drawn in order.
};

}  // namespace earthwork::viewer
