#include "client/viewer/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "client/viewer/render/batches.hpp"
#include "client/viewer/render/dots.hpp"
#include "client/viewer/render/light.hpp"
#include "client/viewer/render/lines.hpp"
#include "client/viewer/render/plane.hpp"
#include "client/viewer/render/projection.hpp"

namespace earthwork::viewer {
namespace {

using protocol::Result;

constexpr const char* kGroundFragment = R"(
in vec2 voxels;
uniform vec3 color;
out vec4 pixel;
void main() { pixel = vec4(color, 1.0); }
)";

constexpr double kHaloWidth = 1.25;  // CSS pixels around an outline

/// Where empty ground lies: below all walls.
double ground_height(const protocol::MapSettings& settings) {
  double lowest = 0;
  for (const protocol::LayerSettings& layer : settings.layers)
    lowest = std::min(lowest, layer.bottom);
  return lowest;
}

struct Parts {
  render::Batches batches;
  render::Plane ground;
  render::Dots dots;
  render::Lines lines;
};

class GlRenderer final : public Renderer {
 public:
  explicit GlRenderer(Parts parts)
      : parts_(std::move(parts)), ground_color_(parts_.ground.uniform("color")) {}

  void update(const scene::Scene::Chunks& chunks, std::span<const protocol::ChunkKey> changed,
              const protocol::MapSettings& settings) override {
    parts_.batches.update(chunks, changed, settings.chunk_resolution);
  }
  void clear() override { parts_.batches.clear(); }
  DrawCounts draw(const Picture& picture) override;

 private:
  void begin(const render::Projection& projection) const;
  std::size_t draw_ground(const Picture& picture, const render::Projection& projection);
  std::size_t draw_border(const Picture& picture, const render::Projection& projection);
  std::size_t draw_outlines(const Picture& picture, const render::Projection& projection);

  Parts parts_;
  GLint ground_color_;
  render::LineMesh lines_;  // memory that is used again
};

void GlRenderer::begin(const render::Projection& projection) const {
  glViewport(0, 0, projection.width, projection.height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  // The picture stays opaque whatever is laid over it.
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  const auto& outside = render::kOutsideColor;
  glClearColor(outside[0], outside[1], outside[2], 1);
  glClearDepthf(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

std::size_t GlRenderer::draw_ground(const Picture& picture, const render::Projection& projection) {
  const double height = ground_height(picture.settings);
  const auto seen = render::seen_ground(picture, height);
  if (!seen) return 0;
  const auto& inside = render::kInsideColor;
  parts_.ground.use(projection);
  glUniform3f(ground_color_, inside[0], inside[1], inside[2]);
  parts_.ground.draw(*seen, height, 0, projection);
  return 1;
}

std::size_t GlRenderer::draw_border(const Picture& picture, const render::Projection& projection) {
  if (!picture.settings.chunks) return 0;
  const protocol::MapRect ground = render::map_ground(picture.settings);
  const std::array<protocol::MapPoint, 4> corners = {{{ground.x0, ground.y0},
                                                      {ground.x1, ground.y0},
                                                      {ground.x1, ground.y1},
                                                      {ground.x0, ground.y1}}};
  lines_.clear();
  lines_.add(picture, corners, true, ground_height(picture.settings),
             {render::kBorderColor, render::kBorderWidth * picture.pixel_ratio, 0});
  return parts_.lines.draw(lines_, projection);
}

std::size_t GlRenderer::draw_outlines(const Picture& picture,
                                      const render::Projection& projection) {
  lines_.clear();
  for (const Outline& outline : picture.outlines) {
    lines_.add(
        picture, outline.points, outline.closed, outline.height,
        {outline.color, outline.width * picture.pixel_ratio, kHaloWidth * picture.pixel_ratio});
  }
  return parts_.lines.draw(lines_, projection);
}

DrawCounts GlRenderer::draw(const Picture& picture) {
  const render::Projection projection = render::projection_of(picture);
  begin(projection);
  // What lies on the ground lies below all else: painted in order, it needs no depths. Shadows
  // use them to darken nothing twice.
  std::size_t draws = draw_ground(picture, projection);
  glEnable(GL_BLEND);
  draws += draw_border(picture, projection);
  glEnable(GL_DEPTH_TEST);
  draws += parts_.batches.draw_shadows(picture, projection, ground_height(picture.settings));

  glDisable(GL_BLEND);
  DrawCounts counts = parts_.batches.draw(picture, projection);

  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  draws += parts_.dots.draw(picture, projection);
  glDisable(GL_DEPTH_TEST);
  draws += draw_outlines(picture, projection);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glBindVertexArray(0);
  glUseProgram(0);
  counts.draws += draws;
  return counts;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::make() {
  render::resolve_deletes();
  auto batches = render::Batches::make();
  if (!batches) return tl::unexpected(batches.error());
  auto ground = render::Plane::make(kGroundFragment);
  if (!ground) return tl::unexpected(ground.error());
  auto dots = render::Dots::make();
  if (!dots) return tl::unexpected(dots.error());
  auto lines = render::Lines::make();
  if (!lines) return tl::unexpected(lines.error());
  return std::make_unique<GlRenderer>(
      Parts{std::move(*batches), std::move(*ground), std::move(*dots), std::move(*lines)});
}

}  // namespace earthwork::viewer
