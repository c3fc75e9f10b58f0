/// What an editor of a load run paints: circles along a walk drawn by lot, the same for the same
/// seed on every machine.
#pragma once

#include <cstdint>
#include <random>

#include "protocol/edit.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

/// Map units; the walk's centres lie inside.
struct PaintedSquare {
  double x0 = 0, y0 = 0, side = 0;
  friend bool operator==(const PaintedSquare&, const PaintedSquare&) = default;
};

/// The square of at most `side` map units whose lower left corner is the map's, or (0, 0) where
/// the map has no bounds.
[[nodiscard]] PaintedSquare painted_square(const protocol::MapSettings& settings, double side);

/// Strokes of some twenty circles, each about a radius from the one before; a stroke fills or
/// empties, as often the one as the other, so that the ground stays busy. Half of the strokes begin
/// where the last one ended, half somewhere else.
class BrushWalk {
 public:
  /// `radius` > 0, map units.
  BrushWalk(const PaintedSquare& square, double radius, std::uint64_t seed);
  /// The next edit of layer 0; its stroke is numbered from 1 on.
  [[nodiscard]] protocol::Edit next();

 private:
  double between(double low, double high);
  void begin_stroke();
  void step();

  PaintedSquare square_;
  double radius_;
  std::mt19937_64 random_;
  double x_ = 0, y_ = 0, heading_ = 0;
  int left_ = 0;  // circles of the stroke
  bool fill_ = true;
  std::int64_t stroke_ = 0;
};

}  // namespace earthwork::bot
