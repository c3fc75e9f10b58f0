#include "client/bot/trace_plan.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "client/bot/square_cover.hpp"
#include "protocol/limits.hpp"

namespace earthwork::bot {
namespace {

using protocol::Edit;
using protocol::MapSettings;

// Each about a third longer than the next. With every side a coastline takes a tenth fewer
// squares, but ten times the edits: the squares of one edit are all alike.
constexpr int kSides[] = {512, 384, 256, 192, 128, 96, 64, 48, 32, 24, 16, 12, 8, 6, 4, 3, 2, 1};

// A hole of up to so many pixels, hanging together by their sides, is painted over and
// emptied again: one or two squares more there, several fewer around it.
constexpr std::size_t kSmallHole = 8;

enum class Paint { empty, fill };

Edit stamp_all(std::span<const PixelSquare> squares, Paint paint, int height, double voxel_size) {
  Edit edit;
  edit.stencil = protocol::StencilShape::square;
  edit.fill = paint == Paint::fill;
  edit.is_path = true;
  const double half = squares.front().side / 2.0;
  edit.radius = half * voxel_size;
  edit.path.reserve(squares.size());
  for (const PixelSquare& s : squares)
    edit.path.push_back({(s.x + half) * voxel_size, (height - s.y - half) * voxel_size});
  return edit;
}

/// The sides that a stamp may have wherever it lies: at the origin it reaches into the chunks to
/// the left and below, which is as many chunks as it can touch.
std::vector<int> usable_sides(const MapSettings& settings) {
  MapSettings unbounded = settings;
  unbounded.chunks.reset();
  std::vector<int> out;
  for (const int side : kSides) {
    const PixelSquare square{.x = 0, .y = 0, .side = side};
    const Edit edit = stamp_all({&square, 1}, Paint::fill, side, settings.voxel_size);
    if (protocol::check_edit(edit, unbounded)) out.push_back(side);
  }
  return out;
}

using Pixels = std::vector<std::pair<int, int>>;

/// Whether (x, y) lies in a small hole, and then its pixels. What reaches the picture's edge is no
/// hole.
bool find_small_hole(const Bitmap& picture, int x, int y, Pixels& hole) {
  hole.assign(1, {x, y});
  for (std::size_t next = 0; next < hole.size(); ++next) {
    const auto [hx, hy] = hole[next];
    if (hx == 0 || hy == 0 || hx == picture.width() - 1 || hy == picture.height() - 1) return false;
    for (const auto& beside : {std::pair(hx - 1, hy), {hx + 1, hy}, {hx, hy - 1}, {hx, hy + 1}})
      if (!picture.at(beside.first, beside.second) &&
          std::find(hole.begin(), hole.end(), beside) == hole.end())
        hole.push_back(beside);
    if (hole.size() > kSmallHole) return false;
  }
  return true;
}

/// The picture with its small holes set.
Bitmap without_small_holes(const Bitmap& picture) {
  Bitmap out = picture;
  Pixels hole;
  // By rows, the first pixel of a hole has nothing clear above it or to its left.
  for (int y = 1; y < picture.height(); ++y)
    for (int x = 1; x < picture.width(); ++x) {
      if (picture.at(x, y) || !picture.at(x - 1, y) || !picture.at(x, y - 1)) continue;
      if (!find_small_hole(picture, x, y, hole)) continue;
      for (const auto& [hx, hy] : hole) out.set(hx, hy, true);
    }
  return out;
}

class Planner {
 public:
  Planner(const Bitmap& picture, const MapSettings& settings)
      : picture_(picture), settings_(settings), sides_(usable_sides(settings)) {}

  /// Paints all that is set in `wanted`, and perhaps more that is set in `allowed`.
  void paint(const Bitmap& wanted, const Bitmap& allowed, Paint paint) {
    const auto squares = cover_with_squares(wanted, allowed, sides_);
    for (auto first = squares.begin(); first != squares.end();) {
      const auto last = std::find_if(first, squares.end(),
                                     [&](const PixelSquare& s) { return s.side != first->side; });
      add({first, last}, paint);
      first = last;
    }
  }

  std::vector<Edit> take() { return std::move(edits_); }

 private:
  /// Equal squares, in as few edits as the limits allow.
  void add(std::span<const PixelSquare> squares, Paint paint) {
    while (!squares.empty()) {
      std::size_t count = std::min(protocol::kMaxPathPoints, squares.size());
      Edit edit = stamps(squares.first(count), paint);
      while (count > 1 && !protocol::check_edit(edit, settings_)) {
        count = (count + 1) / 2;
        edit = stamps(squares.first(count), paint);
      }
      edits_.push_back(std::move(edit));
      squares = squares.subspan(count);
    }
  }

  Edit stamps(std::span<const PixelSquare> squares, Paint paint) const {
    return stamp_all(squares, paint, picture_.height(), settings_.voxel_size);
  }

  const Bitmap& picture_;
  const MapSettings& settings_;
  const std::vector<int> sides_;
  std::vector<Edit> edits_;
};

Bitmap inverse(const Bitmap& picture) {
  Bitmap out = picture;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = !picture[i];
  return out;
}

}  // namespace

std::vector<Edit> plan_trace(const Bitmap& picture, Ground ground, const MapSettings& settings) {
  Planner planner(picture, settings);
  const Bitmap clear = inverse(picture), filled_over = without_small_holes(picture);
  Bitmap holes = filled_over;
  for (std::size_t i = 0; i < holes.size(); ++i) holes[i] = filled_over[i] && clear[i];

  if (ground == Ground::unknown) {
    const Bitmap everything = inverse(Bitmap(picture.width(), picture.height()));
    planner.paint(everything, everything, Paint::empty);
  }
  planner.paint(picture, filled_over, Paint::fill);
  planner.paint(holes, clear, Paint::empty);
  return planner.take();
}

}  // namespace earthwork::bot
