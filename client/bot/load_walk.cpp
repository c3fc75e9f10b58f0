#include "client/bot/load_walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace earthwork::bot {
namespace {

constexpr int kLeastStroke = 8, kMostStroke = 32;
constexpr double kMaxTurn = 0.6;  // radians a step
constexpr double kPartsOfUnit = 64;

// Centres on 1/64 of a map unit keep the messages as short as a person's would be.
double rounded(double coordinate) { return std::round(coordinate * kPartsOfUnit) / kPartsOfUnit; }

}  // namespace

PaintedSquare painted_square(const protocol::MapSettings& settings, double side) {
  if (!settings.chunks) return {.x0 = 0, .y0 = 0, .side = side};
  const auto& [cx0, cy0, cx1, cy1] = *settings.chunks;
  const double chunk = settings.chunk_resolution * settings.voxel_size;
  return {.x0 = cx0 * chunk,
          .y0 = cy0 * chunk,
          .side = std::min({side, (cx1 - cx0) * chunk, (cy1 - cy0) * chunk})};
}

BrushWalk::BrushWalk(const PaintedSquare& square, double radius, std::uint64_t seed)
    : square_(square), radius_(radius), random_(seed) {}

protocol::Edit BrushWalk::next() {
  if (left_ == 0)
    begin_stroke();
  else
    step();
  --left_;
  protocol::Edit edit;
  edit.fill = fill_;
  edit.radius = radius_;
  edit.path = {{.x = rounded(x_), .y = rounded(y_)}};
  edit.stroke = stroke_;
  return edit;
}

// The standard's distributions differ between libraries, its engines do not.
double BrushWalk::between(double low, double high) {
  constexpr int kUnusedBits = 11;  // 53 remain, what a double holds
  return low + (high - low) * std::ldexp(static_cast<double>(random_() >> kUnusedBits), -53);
}

void BrushWalk::begin_stroke() {
  const bool elsewhere = stroke_ == 0 || between(0, 1) < 0.5;
  ++stroke_;
  left_ = static_cast<int>(between(kLeastStroke, kMostStroke + 1));
  fill_ = between(0, 1) < 0.5;
  heading_ = between(0, 2 * std::numbers::pi);
  if (!elsewhere) return step();
  x_ = square_.x0 + between(0, square_.side);
  y_ = square_.y0 + between(0, square_.side);
}

void BrushWalk::step() {
  heading_ += between(-kMaxTurn, kMaxTurn);
  const double length = between(0.5, 1.5) * radius_;
  const double x = x_ + length * std::cos(heading_), y = y_ + length * std::sin(heading_);
  x_ = std::clamp(x, square_.x0, square_.x0 + square_.side);
  y_ = std::clamp(y, square_.y0, square_.y0 + square_.side);
  if (x != x_ || y != y_) heading_ += std::numbers::pi / 2;  // along the border, or back
}

}  // namespace earthwork::bot
