/// Draws line meshes.
#pragma once

#include <cstddef>

#include "client/viewer/render/line_mesh.hpp"
#include "client/viewer/render/program.hpp"
#include "client/viewer/render/projection.hpp"

namespace earthwork::viewer::render {

class Lines {
 public:
  [[nodiscard]] static protocol::Result<Lines> make();

  /// In order, over all that is there. Gives back its calls.
  std::size_t draw(const LineMesh& mesh, const Projection& projection) const;

 private:
  explicit Lines(Program program);

  Program program_;
  VertexArray array_;
  Buffer vertices_, indices_;
  GLint pixels_;
};

}  // namespace earthwork::viewer::render
