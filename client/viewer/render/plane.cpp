#include "client/viewer/render/plane.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::viewer::render {
namespace {

constexpr const char* kVertex = R"(
uniform mat4 clip;
uniform vec4 rect;   // x0, y0, x1, y1
uniform vec2 place;  // height, bias
out vec2 voxels;
void main() {
  voxels = vec2((gl_VertexID & 1) == 0 ? rect.x : rect.z, gl_VertexID < 2 ? rect.y : rect.w);
  gl_Position = clip * vec4(voxels, place.x, 1.0);
  gl_Position.z -= place.y * gl_Position.w;
}
)";

}  // namespace

protocol::MapRect map_ground(const protocol::MapSettings& settings) {
  const protocol::ChunkRange extent = protocol::map_extent(settings);
  const double side = settings.chunk_resolution * settings.voxel_size;
  return {extent.x0 * side, extent.y0 * side, extent.x1 * side, extent.y1 * side};
}

std::optional<protocol::MapRect> seen_ground(const Picture& picture, double height) {
  const protocol::MapRect ground = map_ground(picture.settings);
  const protocol::MapRect seen = picture.camera.seen(height, height);
  const protocol::MapRect both{std::max(ground.x0, seen.x0), std::max(ground.y0, seen.y0),
                               std::min(ground.x1, seen.x1), std::min(ground.y1, seen.y1)};
  if (!(both.x0 < both.x1 && both.y0 < both.y1)) return std::nullopt;
  return both;
}

protocol::Result<Plane> Plane::make(const char* fragment) {
  auto program = Program::make(kVertex, fragment);
  if (!program) return tl::unexpected(program.error());
  return Plane(std::move(*program));
}

Plane::Plane(Program program)
    : program_(std::move(program)),
      clip_(program_.uniform("clip")),
      rect_(program_.uniform("rect")),
      place_(program_.uniform("place")) {}

void Plane::use(const Projection& projection) const {
  program_.use();
  glUniformMatrix4fv(clip_, 1, GL_FALSE, projection.clip_from_voxels.data());
}

void Plane::draw(const protocol::MapRect& rect, double height, float bias,
                 const Projection& projection) const {
  const double s = projection.voxel_size;
  const auto voxels = [&](double place, double origin) {
    return static_cast<float>(place / s - origin);
  };
  glUniform4f(rect_, voxels(rect.x0, projection.origin_x), voxels(rect.y0, projection.origin_y),
              voxels(rect.x1, projection.origin_x), voxels(rect.y1, projection.origin_y));
  glUniform2f(place_, static_cast<float>(height), bias);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace earthwork::viewer::render
