/// OpenGL as it is included: 3.3 core natively, WebGL 2 in the browser. What is used is common to
/// both: no polygon modes, no mapped buffers, no base vertices.
#pragma once

#ifdef __EMSCRIPTEN__
#include <GLES3/gl3.h>
#else
#include <epoxy/gl.h>
#endif

namespace earthwork::viewer::render {

/// The first lines of every shader.
#ifdef __EMSCRIPTEN__
inline constexpr const char* kShaderHead =
    "#version 300 es\nprecision highp float;\nprecision highp int;\n";
#else
inline constexpr const char* kShaderHead = "#version 330 core\n";
#endif

}  // namespace earthwork::viewer::render
