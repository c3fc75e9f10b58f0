#include "client/viewer/render/program.hpp"

#include <array>

namespace earthwork::viewer::render {
namespace {

using protocol::Code;
using protocol::Result;

/// Compiles and attaches; the shader lives as long as the program then.
Result<void> attach(GLuint program, GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const std::array<const char*, 2> parts = {kShaderHead, source.c_str()};
  glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<char, 1024> words{};
  if (compiled != GL_TRUE)
    glGetShaderInfoLog(shader, static_cast<GLsizei>(words.size()), nullptr, words.data());
  glAttachShader(program, shader);
  glDeleteShader(shader);
  if (compiled == GL_TRUE) return {};
  return fail(Code::not_supported, std::string("a shader does not compile: ") + words.data());
}

}  // namespace

Result<Program> Program::make(const std::string& vertex, const std::string& fragment) {
  Program program;
  const GLuint name = program.name_.get();
  if (auto done = attach(name, GL_VERTEX_SHADER, vertex); !done)
    return tl::unexpected(done.error());
  if (auto done = attach(name, GL_FRAGMENT_SHADER, fragment); !done)
    return tl::unexpected(done.error());
  glLinkProgram(name);
  GLint linked = GL_FALSE;
  glGetProgramiv(name, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<char, 1024> words{};
  glGetProgramInfoLog(name, static_cast<GLsizei>(words.size()), nullptr, words.data());
  return fail(Code::not_supported, std::string("shaders do not link: ") + words.data());
}

}  // namespace earthwork::viewer::render
