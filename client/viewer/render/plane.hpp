/// A rectangle that lies flat on a map, for shaders that fill it: the ground, and the voxel dots.
#pragma once

#include <optional>

#include "client/viewer/render/program.hpp"
#include "client/viewer/render/projection.hpp"
#include "protocol/chunk_range.hpp"

namespace earthwork::viewer::render {

/// The map's own ground, map units: its bounds, or those of the world.
[[nodiscard]] protocol::MapRect map_ground(const protocol::MapSettings& settings);

/// What is seen of the map's ground at `height`; none when nothing is.
[[nodiscard]] std::optional<protocol::MapRect> seen_ground(const Picture& picture, double height);

class Plane {
 public:
  /// `fragment` is GLSL that has `in vec2 voxels`, voxels from the projection's origin.
  [[nodiscard]] static protocol::Result<Plane> make(const char* fragment);

  [[nodiscard]] GLint uniform(const char* name) const { return program_.uniform(name); }
  /// Sets the program up; uniforms may be set after it.
  void use(const Projection& projection) const;
  /// `bias` as kLayerBias, of the depth range.
  void draw(const protocol::MapRect& rect, double height, float bias,
            const Projection& projection) const;

 private:
  explicit Plane(Program program);

  Program program_;
  VertexArray nothing_;  // the corners are counted by the shader
  GLint clip_, rect_, place_;
};

}  // namespace earthwork::viewer::render
