/// The batches on the graphics card, and how they are drawn: lit, and as shadows on the ground.
#pragma once

#include <bitset>
#include <cstddef>
#include <map>
#include <span>

#include "client/viewer/render/batch_mesh.hpp"
#include "client/viewer/render/program.hpp"
#include "client/viewer/render/projection.hpp"
#include "client/viewer/render/renderer.hpp"

namespace earthwork::viewer::render {

class Batches {
 public:
  [[nodiscard]] static protocol::Result<Batches> make();

  /// As Renderer::update. A map with chunks of another size replaces all there was.
  void update(const scene::Scene::Chunks& chunks, std::span<const protocol::ChunkKey> changed,
              int resolution);
  void clear() { batches_.clear(); }

  /// The layers that are shown, against the depth buffer.
  DrawCounts draw(const Picture& picture, const Projection& projection) const;
  /// What the layers shown darken of the ground at that height: each sample once, with a depth
  /// buffer that is cleared. Nothing when the shadows are too small to be seen. Gives back its
  /// calls.
  std::size_t draw_shadows(const Picture& picture, const Projection& projection,
                           double ground) const;

 private:
  struct Batch {
    VertexArray array;
    Buffer vertices, indices;
    std::size_t index_count = 0;
  };
  struct Pass {
    const Picture& picture;
    const Projection& projection;
    std::bitset<protocol::kMaxLayers> hidden;
    GLint offset = -1;  // the uniform
  };
  struct LitUniforms {
    GLint clip, offset, heights, bias, color;
  };
  struct ShadowUniforms {
    GLint clip, offset, heights, ground, fall, color;
  };

  Batches(Program lit, Program shadow);
  void rebuild(const scene::Scene::Chunks& chunks, const BatchKey& key);
  template <class BoxOf, class SetLayer>
  DrawCounts draw_seen(const Pass& pass, const BoxOf& box_of, const SetLayer& set_layer) const;

  Program lit_, shadow_;
  LitUniforms lit_at_;
  ShadowUniforms shadow_at_;
  int resolution_ = 0;
  std::map<BatchKey, Batch> batches_;
  BatchMesh mesh_;  // used again by each rebuild
};

}  // namespace earthwork::viewer::render
