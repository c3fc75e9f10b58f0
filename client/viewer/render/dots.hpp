/// A dot on every voxel of a map, where one is near enough to tell voxels apart.
#pragma once

#include <cstddef>

#include "client/viewer/render/plane.hpp"

namespace earthwork::viewer::render {

class Dots {
 public:
  [[nodiscard]] static protocol::Result<Dots> make();

  /// On top of the picture's `dots_layer`; what is higher hides them. They fade in between 8 and
  /// 16 CSS pixels a voxel, each where it is. Gives back its calls.
  std::size_t draw(const Picture& picture, const Projection& projection) const;

 private:
  explicit Dots(Plane plane);

  Plane plane_;
  GLint ratio_;
};

}  // namespace earthwork::viewer::render
