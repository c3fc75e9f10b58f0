/// Draws a map with OpenGL: what 3.3 core and WebGL 2 have in common, so that one picture serves
/// the window, the page and files.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "client/scene/scene.hpp"
#include "client/viewer/picture.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/result.hpp"

namespace earthwork::viewer {

struct DrawCounts {
  std::size_t draws = 0;      ///< Calls that drew.
  std::size_t triangles = 0;  ///< Of surfaces and walls, in view.
};

/// On the thread on which the context is current. A lost context takes all with it: make another
/// one, once there is a context again. A renderer whose context is lost may end at any time.
class Renderer {
 public:
  /// Needs a current context. Fails with not_supported, telling what the driver said.
  [[nodiscard]] static protocol::Result<std::unique_ptr<Renderer>> make();
  virtual ~Renderer() = default;

  /// These chunks of the scene are new, changed or gone; all others are as they were. Nothing of
  /// the scene is kept.
  virtual void update(const scene::Scene::Chunks& chunks,
                      std::span<const protocol::ChunkKey> changed,
                      const protocol::MapSettings& settings) = 0;
  /// No chunk is there any more.
  virtual void clear() = 0;
  /// Into the framebuffer that is bound, all of it: camera.size() * pixel_ratio pixels, rounded.
  /// It has a depth buffer, and several samples a pixel if edges shall be smooth.
  virtual DrawCounts draw(const Picture& picture) = 0;
};

}  // namespace earthwork::viewer
