/// A picture drawn without a window or a display: for files and tests. Native only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "protocol/result.hpp"

namespace earthwork::viewer::render {

inline constexpr int kMaxOffscreenSide = 16384;  ///< Pixels; a driver may allow less.

/// A context of its own, current on the thread that makes it until its end, with a framebuffer of
/// four samples a pixel.
class Offscreen {
 public:
  /// `width` and `height` 1 .. kMaxOffscreenSide. Fails with out_of_range, or not_supported when
  /// there is no driver that can do it.
  [[nodiscard]] static protocol::Result<std::unique_ptr<Offscreen>> make(int width, int height);
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// What is drawn next goes into it.
  void bind();
  /// What was drawn: red, green, blue and opacity of each pixel, rows top down.
  [[nodiscard]] std::vector<std::uint8_t> read();
  /// Waits until all that was asked for is drawn.
  void finish();
  /// On the thread no context is current any more: as a window system takes one away.
  void release();

 private:
  struct Framebuffers;
  struct Context;

  Offscreen();

  std::unique_ptr<Context> context_;
  std::unique_ptr<Framebuffers> framebuffers_;
};

}  // namespace earthwork::viewer::render
