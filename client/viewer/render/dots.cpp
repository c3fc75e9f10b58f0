#include "client/viewer/render/dots.hpp"

#include <utility>

namespace earthwork::viewer::render {
namespace {

// A dark dot with a light rim is seen on any ground. Its edges are a pixel wide along the line from
// its centre: `edge` is how many voxels a pixel takes there, also where the map is seen aslant.
constexpr const char* kFragment = R"(
in vec2 voxels;
uniform float ratio;  // pixels to a CSS pixel
out vec4 pixel;
void main() {
  vec2 across = dFdx(voxels), up = dFdy(voxels);
  float per_pixel = max(length(across), length(up));
  float voxel = 1.0 / (per_pixel * ratio);  // CSS pixels
  float near = smoothstep(8.0, 16.0, voxel);
  vec2 from = fract(voxels) - 0.5;
  float far_off = max(length(from), 1e-6);
  vec2 along = from / far_off;
  float edge = max(length(vec2(dot(along, across), dot(along, up))), 1e-6);
  float radius = clamp(0.06 * voxel, 1.1, 3.0) / voxel;
  float rim = radius + 1.0 / voxel;
  float inside = clamp((radius - far_off) / edge + 0.5, 0.0, 1.0);
  float around = clamp((rim - far_off) / edge + 0.5, 0.0, 1.0);
  float opacity = near * mix(0.34 * around, 0.62, inside);
  pixel = vec4(mix(vec3(1.0), vec3(0.13, 0.15, 0.18), inside), opacity);
}
)";

// Zoom at the target below which nothing on the screen is near enough: what is nearest in a picture
// is less than four times nearer.
constexpr double kLeastPixels = 2;

}  // namespace

protocol::Result<Dots> Dots::make() {
  auto plane = Plane::make(kFragment);
  if (!plane) return tl::unexpected(plane.error());
  return Dots(std::move(*plane));
}

Dots::Dots(Plane plane) : plane_(std::move(plane)), ratio_(plane_.uniform("ratio")) {}

std::size_t Dots::draw(const Picture& picture, const Projection& projection) const {
  const auto& layers = picture.settings.layers;
  if (picture.dots_layer >= layers.size()) return 0;
  if (picture.camera.place().zoom * projection.voxel_size < kLeastPixels) return 0;
  const double height = layers[picture.dots_layer].top;
  const auto ground = seen_ground(picture, height);
  if (!ground) return 0;
  plane_.use(projection);
  glUniform1f(ratio_, static_cast<float>(projection.pixel_ratio));
  // Before all layers that share the plane, and no further, or dots would shine through the feet of
  // walls that stand on it.
  plane_.draw(*ground, height, kLayerBias * static_cast<float>(layers.size()), projection);
  return 1;
}

}  // namespace earthwork::viewer::render
