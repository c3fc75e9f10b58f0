/// Lines of the map as strips on the screen: as wide at any distance, with corners that meet.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client/viewer/picture.hpp"

namespace earthwork::viewer::render {

/// Pixels from the picture's lower left corner, y up; `across` is how far from the line's middle.
struct LineVertex {
  float x = 0, y = 0;
  float across = 0;
  float half_width = 0, halo = 0;
  std::array<std::uint8_t, 4> color{};
};

/// Widths in pixels: of the line, and of the contrasting rim on either side of it.
struct LineStyle {
  Color color{};
  double width = 2, halo = 0;
};

struct LineMesh {
  std::vector<LineVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< Three a triangle.

  void clear() { vertices.clear(), indices.clear(); }
  /// Appends what is on the screen, or not far beside it, of the line through `points` at
  /// `height`; all of them finite, map units.
  void add(const Picture& picture, std::span<const protocol::MapPoint> points, bool closed,
           double height, const LineStyle& style);
};

}  // namespace earthwork::viewer::render
