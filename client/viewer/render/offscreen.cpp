#include "client/viewer/render/offscreen.hpp"

#include <epoxy/egl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "client/viewer/render/gl.hpp"

namespace earthwork::viewer::render {
namespace {

using protocol::Code;
using protocol::Result;

constexpr GLsizei kSamples = 4;

tl::unexpected<protocol::Failure> no_context(const char* step) {
  return fail(Code::not_supported, std::string("no OpenGL 3.3 off screen: ") + step + " failed");
}

}  // namespace

struct Offscreen::Context {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  Result<void> make() {
    display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
      return no_context("eglInitialize");
    if (!eglBindAPI(EGL_OPENGL_API)) return no_context("eglBindAPI");
    constexpr std::array<EGLint, 7> kWanted = {EGL_CONTEXT_MAJOR_VERSION,
                                               3,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               3,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_NONE};
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kWanted.data());
    if (context == EGL_NO_CONTEXT) return no_context("eglCreateContext");
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return no_context("eglMakeCurrent");
    return {};
  }
  // The display is the process's, and stays: others may draw on it.
  ~Context() {
    if (context == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context)
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
};

/// They go with the context.
struct Offscreen::Framebuffers {
  GLsizei width = 1, height = 1;
  GLuint drawn = 0, resolved = 0;

  bool make(int wide, int high) {
    width = wide;
    height = high;
    drawn = one(kSamples, true);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) return false;
    resolved = one(0, false);
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }

 private:
  GLuint one(GLsizei samples, bool depth) const {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    attach(GL_COLOR_ATTACHMENT0, GL_RGBA8, samples);
    if (depth) attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, samples);
    return framebuffer;
  }
  void attach(GLenum place, GLenum format, GLsizei samples) const {
    GLuint buffer = 0;
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  }
};

Offscreen::Offscreen()
    : context_(std::make_unique<Context>()), framebuffers_(std::make_unique<Framebuffers>()) {}
Offscreen::~Offscreen() = default;

Result<std::unique_ptr<Offscreen>> Offscreen::make(int width, int height) {
  for (const int side : {width, height}) {
    if (side < 1 || side > kMaxOffscreenSide)
      return fail(Code::out_of_range,
                  "a picture has 1 to " + std::to_string(kMaxOffscreenSide) + " pixels a side",
                  "size");
  }
  std::unique_ptr<Offscreen> made(new Offscreen);
  if (auto done = made->context_->make(); !done) return tl::unexpected(done.error());
  GLint allowed = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &allowed);
  if (std::max(width, height) > allowed)
    return fail(Code::out_of_range,
                "the driver draws " + std::to_string(allowed) + " pixels a side at most", "size");
  if (!made->framebuffers_->make(width, height)) return no_context("a framebuffer");
  made->bind();
  return made;
}

void Offscreen::bind() { glBindFramebuffer(GL_FRAMEBUFFER, framebuffers_->drawn); }

void Offscreen::finish() { glFinish(); }

void Offscreen::release() {
  eglMakeCurrent(context_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

std::vector<std::uint8_t> Offscreen::read() {
  const GLsizei width = framebuffers_->width, height = framebuffers_->height;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_->drawn);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_->resolved);
  glDisable(GL_SCISSOR_TEST);  // it would cut what is copied
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_->resolved);
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> rows(row * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
  for (std::size_t low = 0, high = static_cast<std::size_t>(height) - 1; low < high; ++low, --high)
    std::swap_ranges(rows.begin() + static_cast<std::ptrdiff_t>(low * row),
                     rows.begin() + static_cast<std::ptrdiff_t>((low + 1) * row),
                     rows.begin() + static_cast<std::ptrdiff_t>(high * row));
  bind();
  return rows;
}

}  // namespace earthwork::viewer::render
