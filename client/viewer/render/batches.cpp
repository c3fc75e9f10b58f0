#include "client/viewer/render/batches.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "client/viewer/render/light.hpp"

namespace earthwork::viewer::render {
namespace {

using protocol::MapRect;

constexpr GLuint kPosition = 0, kNormal = 1, kKind = 2;

// Behind all that is seen of a map, and before what a depth buffer is cleared to.
constexpr float kShadowDepth = 1.0F - 1.0F / (1 << 20);

constexpr const char* kInputs = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 normal;
layout(location = 2) in vec2 kind;
uniform mat4 clip;
uniform vec2 offset;
uniform vec2 heights;
)";
// Walls have a tone of their own. Corners are lit, not pixels: on a wall that costs nothing to see,
// and most of what is drawn faces up.
constexpr const char* kLitVertex = R"(
uniform float bias;
uniform vec3 color;
centroid out vec3 shade;
centroid out float depth;
void main() {
  float height = kind.x > 0.5 ? heights.y : heights.x;
  gl_Position = clip * vec4(offset + position, height, 1.0);
  gl_Position.z -= bias * gl_Position.w;
  bool wall = kind.y > 0.5;
  vec3 tone = mix(vec3(dot(color, vec3(0.3, 0.6, 0.1))), color, 1.08) * 0.93;
  shade = wall ? lit(clamp(tone, 0.0, 1.0), normalize(vec3(normal, 0.0))) : color;
  depth = wall ? 1.0 - kind.x : 0.0;
}
)";
// Darker toward a wall's foot, where less of the sky is seen.
constexpr const char* kLitFragment = R"(
centroid in vec3 shade;
centroid in float depth;
out vec4 pixel;
void main() { pixel = vec4(shade * (1.0 - 0.38 * depth * depth), 1.0); }
)";
constexpr const char* kShadowVertex = R"(
uniform float ground;
uniform vec2 fall;
void main() {
  float height = kind.x > 0.5 ? heights.y : heights.x;
  vec2 place = offset + position + fall * (height - ground);
  gl_Position = clip * vec4(place, ground, 1.0);
}
)";
constexpr const char* kShadowFragment = R"(
uniform vec4 color;
out vec4 pixel;
void main() { pixel = color; }
)";

void describe_vertices() {
  const auto at = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  constexpr GLsizei stride = sizeof(BatchVertex);
  glEnableVertexAttribArray(kPosition);
  glVertexAttribPointer(kPosition, 2, GL_FLOAT, GL_FALSE, stride, at(offsetof(BatchVertex, x)));
  glEnableVertexAttribArray(kNormal);
  glVertexAttribPointer(kNormal, 2, GL_SHORT, GL_TRUE, stride, at(offsetof(BatchVertex, normal)));
  glEnableVertexAttribArray(kKind);
  glVertexAttribPointer(kKind, 2, GL_SHORT, GL_FALSE, stride, at(offsetof(BatchVertex, top)));
}

template <class T>
void fill(GLenum target, const std::vector<T>& values) {
  glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(),
               GL_DYNAMIC_DRAW);
}

/// Where the meshes of a batch can be, map units: cells reach half a voxel beyond their chunks.
MapRect extent(const BatchKey& key, double voxel_size) {
  const double side = kBatchVoxels * voxel_size;
  return {key.x * side, key.y * side, (key.x + 1) * side + voxel_size,
          (key.y + 1) * side + voxel_size};
}

/// What is looked for before a batch is drawn.
struct Box {
  MapRect rect;
  double bottom = 0, top = 0;
};

/// The ground that the batch's shadow lies on.
Box shadow_box(MapRect rect, const protocol::LayerSettings& layer, double ground) {
  const double rise = layer.top - ground;
  rect.x0 += std::min(0.0, kShadowFall[0] * rise);
  rect.x1 += std::max(0.0, kShadowFall[0] * rise);
  rect.y0 += std::min(0.0, kShadowFall[1] * rise);
  rect.y1 += std::max(0.0, kShadowFall[1] * rise);
  return {rect, ground, ground};
}

/// 0 .. 1: how much of a layer's shadow is seen. One that reaches less than 2 CSS pixels beyond
/// what casts it (near the target) would only blur it, and cost as much as the map itself.
float shadow_share(const Picture& picture, const protocol::LayerSettings& layer, double ground) {
  const double reach = std::hypot(kShadowFall[0], kShadowFall[1]) * (layer.top - ground);
  return static_cast<float>(std::clamp((reach * picture.camera.place().zoom - 2) / 2, 0.0, 1.0));
}

}  // namespace

protocol::Result<Batches> Batches::make() {
  const std::string inputs = kInputs;
  auto lit = Program::make(inputs + kLightCode + kLitVertex, kLitFragment);
  if (!lit) return tl::unexpected(lit.error());
  auto shadow = Program::make(inputs + kShadowVertex, kShadowFragment);
  if (!shadow) return tl::unexpected(shadow.error());
  return Batches(std::move(*lit), std::move(*shadow));
}

Batches::Batches(Program lit, Program shadow)
    : lit_(std::move(lit)),
      shadow_(std::move(shadow)),
      lit_at_{lit_.uniform("clip"), lit_.uniform("offset"), lit_.uniform("heights"),
              lit_.uniform("bias"), lit_.uniform("color")},
      shadow_at_{shadow_.uniform("clip"),   shadow_.uniform("offset"), shadow_.uniform("heights"),
                 shadow_.uniform("ground"), shadow_.uniform("fall"),   shadow_.uniform("color")} {}

void Batches::update(const scene::Scene::Chunks& chunks,
                     std::span<const protocol::ChunkKey> changed, int resolution) {
  std::vector<BatchKey> touched;
  const bool anew = resolution != resolution_;
  if (anew) {
    clear();
    resolution_ = resolution;
    for (const auto& [key, chunk] : chunks) touched.push_back(batch_of(key, resolution));
  } else {
    for (const protocol::ChunkKey& key : changed) touched.push_back(batch_of(key, resolution));
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const BatchKey& key : touched) rebuild(chunks, key);
  glBindVertexArray(0);
}

void Batches::rebuild(const scene::Scene::Chunks& chunks, const BatchKey& key) {
  mesh_.rebuild(chunks, key, resolution_);
  if (mesh_.indices.empty()) {
    batches_.erase(key);
    return;
  }
  const auto [place, is_new] = batches_.try_emplace(key);
  Batch& batch = place->second;
  batch.index_count = mesh_.indices.size();
  glBindVertexArray(batch.array.get());
  glBindBuffer(GL_ARRAY_BUFFER, batch.vertices.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, batch.indices.get());
  if (is_new) describe_vertices();
  fill(GL_ARRAY_BUFFER, mesh_.vertices);
  fill(GL_ELEMENT_ARRAY_BUFFER, mesh_.indices);
}

template <class BoxOf, class SetLayer>
DrawCounts Batches::draw_seen(const Pass& pass, const BoxOf& box_of,
                              const SetLayer& set_layer) const {
  const auto& layers = pass.picture.settings.layers;
  const Projection& projection = pass.projection;
  DrawCounts counts;
  std::int32_t layer = -1;
  glEnable(GL_CULL_FACE);
  for (const auto& [key, batch] : batches_) {
    const auto n = static_cast<std::size_t>(key.layer);
    if (n >= layers.size() || pass.hidden[n]) continue;
    const protocol::LayerSettings& settings = layers[n];
    const Box box = box_of(extent(key, projection.voxel_size), settings);
    if (!pass.picture.camera.sees(box.rect, box.bottom, box.top)) continue;
    if (layer != key.layer) set_layer(settings, key.layer);
    layer = key.layer;
    glUniform2f(pass.offset, static_cast<float>(key.x * kBatchVoxels - projection.origin_x),
                static_cast<float>(key.y * kBatchVoxels - projection.origin_y));
    glBindVertexArray(batch.array.get());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(batch.index_count), GL_UNSIGNED_INT, nullptr);
    counts.draws += 1;
    counts.triangles += batch.index_count / 3;
  }
  glDisable(GL_CULL_FACE);
  return counts;
}

DrawCounts Batches::draw(const Picture& picture, const Projection& projection) const {
  lit_.use();
  glUniformMatrix4fv(lit_at_.clip, 1, GL_FALSE, projection.clip_from_voxels.data());
  const auto box_of = [](const MapRect& rect, const protocol::LayerSettings& layer) {
    return Box{rect, layer.bottom, layer.top};
  };
  const auto set_layer = [&](const protocol::LayerSettings& layer, std::int32_t n) {
    const Color color = color_of(layer.color);
    glUniform3f(lit_at_.color, color[0], color[1], color[2]);
    glUniform2f(lit_at_.heights, static_cast<float>(layer.bottom), static_cast<float>(layer.top));
    glUniform1f(lit_at_.bias, kLayerBias * static_cast<float>(n));
  };
  return draw_seen({picture, projection, picture.hidden, lit_at_.offset}, box_of, set_layer);
}

std::size_t Batches::draw_shadows(const Picture& picture, const Projection& projection,
                                  double ground) const {
  auto hidden = picture.hidden;
  for (std::size_t n = 0; n < picture.settings.layers.size(); ++n)
    if (shadow_share(picture, picture.settings.layers[n], ground) <= 0) hidden.set(n);
  shadow_.use();
  glUniformMatrix4fv(shadow_at_.clip, 1, GL_FALSE, projection.clip_from_voxels.data());
  glUniform1f(shadow_at_.ground, static_cast<float>(ground));
  glUniform2f(shadow_at_.fall, static_cast<float>(kShadowFall[0] / projection.voxel_size),
              static_cast<float>(kShadowFall[1] / projection.voxel_size));
  const auto box_of = [&](const MapRect& rect, const protocol::LayerSettings& layer) {
    return shadow_box(rect, layer, ground);
  };
  const auto set_layer = [&](const protocol::LayerSettings& layer, std::int32_t) {
    glUniform2f(shadow_at_.heights, static_cast<float>(layer.bottom),
                static_cast<float>(layer.top));
    glUniform4f(shadow_at_.color, kShadowColor[0], kShadowColor[1], kShadowColor[2],
                kShadowColor[3] * shadow_share(picture, layer, ground));
  };
  // What faces the lamp casts all of the shadow, and laid on the ground it still faces up: the rest
  // is culled. All of one depth: the first to come darkens a sample, all others fail the test.
  glDepthRangef(kShadowDepth, kShadowDepth);
  const DrawCounts counts =
      draw_seen({picture, projection, hidden, shadow_at_.offset}, box_of, set_layer);
  glDepthRangef(0.0F, 1.0F);
  return counts.draws;
}

}  // namespace earthwork::viewer::render
