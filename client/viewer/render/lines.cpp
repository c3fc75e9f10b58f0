#include "client/viewer/render/lines.hpp"

#include <utility>

namespace earthwork::viewer::render {
namespace {

constexpr const char* kVertex = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 profile;  // across, half width, halo
layout(location = 2) in vec4 color;
uniform vec2 pixels;
out vec3 shape;
out vec4 own;
void main() {
  gl_Position = vec4(position / pixels * 2.0 - 1.0, 0.0, 1.0);
  shape = profile;
  own = color;
}
)";
// The halo is dark around a light line and light around a dark one, and lies below it.
constexpr const char* kFragment = R"(
in vec3 shape;
in vec4 own;
out vec4 pixel;
void main() {
  float off = abs(shape.x);
  float core = clamp(shape.y - off + 0.5, 0.0, 1.0);
  float around = clamp(shape.y + shape.z - off + 0.5, 0.0, 1.0) * step(0.01, shape.z);
  float light = dot(own.rgb, vec3(0.3, 0.59, 0.11));
  vec4 halo = light > 0.55 ? vec4(0.05, 0.06, 0.08, 0.5) : vec4(1.0, 1.0, 1.0, 0.7);
  float below = around * halo.a * own.a * (1.0 - core * own.a);
  float opacity = core * own.a + below;
  pixel = vec4((own.rgb * core * own.a + halo.rgb * below) / max(opacity, 1e-4), opacity);
}
)";

}  // namespace

protocol::Result<Lines> Lines::make() {
  auto program = Program::make(kVertex, kFragment);
  if (!program) return tl::unexpected(program.error());
  return Lines(std::move(*program));
}

Lines::Lines(Program program) : program_(std::move(program)), pixels_(program_.uniform("pixels")) {
  const auto at = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  constexpr GLsizei stride = sizeof(LineVertex);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  for (const GLuint input : {0U, 1U, 2U}) glEnableVertexAttribArray(input);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, at(offsetof(LineVertex, x)));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride, at(offsetof(LineVertex, across)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, at(offsetof(LineVertex, color)));
  glBindVertexArray(0);
}

std::size_t Lines::draw(const LineMesh& mesh, const Projection& projection) const {
  if (mesh.indices.empty()) return 0;
  program_.use();
  glUniform2f(pixels_, static_cast<float>(projection.width), static_cast<float>(projection.height));
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(LineVertex)),
               mesh.vertices.data(), GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
               mesh.indices.data(), GL_STREAM_DRAW);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indices.size()), GL_UNSIGNED_INT, nullptr);
  return 1;
}

}  // namespace earthwork::viewer::render
