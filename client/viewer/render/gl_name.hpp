/// Names of OpenGL's objects, deleted with their owner.
#pragma once

#include <utility>

#include "client/viewer/render/gl.hpp"

namespace earthwork::viewer::render {

/// Owns one object. Made, moved and destroyed on the context's thread. When the context is gone
/// there is nothing left to delete, and deleting does nothing: `resolve_deletes` sees to that.
template <class Kind>
class GlName {
 public:
  GlName() : name_(Kind::make()) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Kind::drop(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

struct BufferKind {
  static GLuint make() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayKind {
  static GLuint make() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return name;
  }
  static void drop(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct ProgramKind {
  static GLuint make() { return glCreateProgram(); }
  static void drop(GLuint name) { glDeleteProgram(name); }
};

using Buffer = GlName<BufferKind>;
using VertexArray = GlName<VertexArrayKind>;
using ProgramName = GlName<ProgramKind>;

/// Natively a function is looked up when it is first called, which takes a context. Called with
/// one, so that destructors without one find their functions.
inline void resolve_deletes() {
  glDeleteBuffers(0, nullptr);
  glDeleteVertexArrays(0, nullptr);
  glDeleteProgram(0);
}

}  // namespace earthwork::viewer::render
