#include "client/viewer/web/canvas.hpp"

#include <emscripten.h>
#include <emscripten/html5.h>
#include <emscripten/html5_webgl.h>

#include <algorithm>
#include <cmath>

#include "client/viewer/web/browser.hpp"

namespace earthwork::viewer {
namespace {

// No display is larger; what a page is told by mistake may be.
constexpr double kMaxSidePixels = 8192;

CanvasListener& listener_of(void* user) { return *static_cast<CanvasListener*>(user); }

// Prevented is that the browser gives the context up for good.
EM_BOOL on_lost(int, const void*, void* user) {
  listener_of(user).canvas_lost();
  return EM_TRUE;
}

EM_BOOL on_restored(int, const void*, void* user) {
  listener_of(user).canvas_restored();
  return EM_TRUE;
}

}  // namespace

protocol::Result<void> Canvas::open() {
  EmscriptenWebGLContextAttributes attributes;
  emscripten_webgl_init_context_attributes(&attributes);
  attributes.majorVersion = 2;
  attributes.alpha = EM_FALSE;
  attributes.depth = EM_TRUE;
  attributes.stencil = EM_FALSE;
  attributes.antialias = EM_TRUE;
  attributes.preserveDrawingBuffer = EM_FALSE;
  attributes.enableExtensionsByDefault = EM_FALSE;
  const EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context =
      emscripten_webgl_create_context(kCanvas, &attributes);
  if (context <= 0 || emscripten_webgl_make_context_current(context) != EMSCRIPTEN_RESULT_SUCCESS)
    return protocol::fail(protocol::Code::not_supported,
                          "This browser offers no WebGL 2, which the map is drawn with.");
  return {};
}

void Canvas::watch() {
  emscripten_set_webglcontextlost_callback(kCanvas, &listener_, EM_FALSE, on_lost);
  emscripten_set_webglcontextrestored_callback(kCanvas, &listener_, EM_FALSE, on_restored);
  browser_watch_size(kCanvas, this);
}

void Canvas::lay_out(scene::ScreenSize size, double pixel_ratio) {
  size.width = std::max(1.0, size.width);
  size.height = std::max(1.0, size.height);
  const double ratio = std::min(pixel_ratio, kMaxSidePixels / std::max(size.width, size.height));
  const int width = static_cast<int>(std::lround(size.width * ratio));
  const int height = static_cast<int>(std::lround(size.height * ratio));
  if (width == width_pixels_ && height == height_pixels_) return;
  width_pixels_ = width;
  height_pixels_ = height;
  emscripten_set_canvas_element_size(kCanvas, width, height);
  listener_.canvas_resized(size, ratio);
}

}  // namespace earthwork::viewer

extern "C" EMSCRIPTEN_KEEPALIVE void earthwork_lay_out(void* canvas, double width, double height,
                                                       double pixel_ratio) {
  static_cast<earthwork::viewer::Canvas*>(canvas)->lay_out({width, height}, pixel_ratio);
}
