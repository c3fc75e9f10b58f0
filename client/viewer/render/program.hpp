/// A vertex and a fragment shader, linked.
#pragma once

#include <string>

#include "client/viewer/render/gl_name.hpp"
#include "protocol/result.hpp"

namespace earthwork::viewer::render {

class Program {
 public:
  /// From GLSL without a `#version`, in what 3.30 and 3.00 ES have in common. Fails with
  /// not_supported and the driver's words.
  [[nodiscard]] static protocol::Result<Program> make(const std::string& vertex,
                                                      const std::string& fragment);

  void use() const { glUseProgram(name_.get()); }
  /// Where a uniform is set; -1, which OpenGL ignores, when no shader uses it.
  [[nodiscard]] GLint uniform(const char* name) const {
    return glGetUniformLocation(name_.get(), name);
  }

 private:
  Program() = default;

  ProgramName name_;
};

}  // namespace earthwork::viewer::render
