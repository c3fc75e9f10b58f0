/// The page's canvas and its WebGL 2 context: as large as the page lays it out, as fine as the
/// display.
#pragma once

#include "client/scene/camera.hpp"
#include "protocol/result.hpp"

namespace earthwork::viewer {

/// Its id in the page, as a selector.
inline constexpr const char* kCanvas = "#canvas";

/// Told from the browser's event loop, and of the size from within `Canvas::watch`.
class CanvasListener {
 public:
  /// What was drawn is gone: to be drawn again before the next picture.
  virtual void canvas_resized(scene::ScreenSize size, double pixel_ratio) = 0;
  /// All that was made with the context is gone.
  virtual void canvas_lost() = 0;
  /// The context is current again, and empty.
  virtual void canvas_restored() = 0;

 protected:
  ~CanvasListener() = default;
};

class Canvas {
 public:
  explicit Canvas(CanvasListener& listener) : listener_(listener) {}
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Makes the context, smooth at edges, and makes it current. Fails with not_supported.
  [[nodiscard]] protocol::Result<void> open();
  /// From now on the listener is told; of the size there is now, at once.
  void watch();

  /// For the browser: the page laid the canvas out anew, or the display is finer or coarser.
  void lay_out(scene::ScreenSize size, double pixel_ratio);

 private:
  CanvasListener& listener_;
  int width_pixels_ = 0, height_pixels_ = 0;
};

}  // namespace earthwork::viewer
