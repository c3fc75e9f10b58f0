/// What a page measures of itself, for tests and for the README: how soon pictures came.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace earthwork::viewer {

/// All times are milliseconds since the page was opened, and never go back.
class Figures {
 public:
  /// How many of the last inputs and pictures are remembered.
  static constexpr std::size_t kKept = 256;

  struct Drawn {
    double began_ms = 0, ended_ms = 0;  ///< The GPU may be at work a little longer.
    bool meshes_changed = false;        ///< Since the last picture.
    bool whole = false;                 ///< All that is in view was there.
    std::size_t triangles = 0, draws = 0;
  };

  /// A button or finger went down.
  void press(double at_ms);
  void draw(const Drawn& drawn);

  /// {"frames", "first_picture_ms"?, "whole_picture_ms"?, "input_to_picture_ms": [...],
  /// "draw_ms": [...], "triangles", "draws", "heap_bytes"}. The first picture is the first one with
  /// a triangle in it. From an input to its picture means from a press to the end of the next
  /// picture in which meshes were new: right where nobody else paints.
  [[nodiscard]] std::string write(std::size_t heap_bytes) const;

 private:
  std::uint64_t frames_ = 0;
  Drawn last_;
  std::optional<double> first_picture_ms_, whole_picture_ms_, pressed_ms_;
  std::vector<double> input_to_picture_ms_, draw_ms_;
};

}  // namespace earthwork::viewer
