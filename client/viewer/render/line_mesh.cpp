#include "client/viewer/render/line_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace earthwork::viewer::render {
namespace {

using Clip = std::array<double, 4>;
using scene::ScreenPoint;

/// Of a segment from 0 to 1: what is left of it. Nothing when from > to.
struct Part {
  double from = 0, to = 1;
  bool empty() const { return from > to; }
};

/// A run of points without a break, in pixels.
struct Run {
  std::vector<ScreenPoint> points;
  bool closed = false;
};

/// The part before the eye and within half a screen of the screen.
Part visible(const Clip& a, const Clip& b) {
  constexpr double kGuard = 2;  // half screens from the middle
  const auto distances = [](const Clip& p) {
    return std::array<double, 5>{p[2] + p[3], kGuard * p[3] - p[0], kGuard * p[3] + p[0],
                                 kGuard * p[3] - p[1], kGuard * p[3] + p[1]};
  };
  const auto in_a = distances(a), in_b = distances(b);
  Part part;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    if (in_a[i] < 0 && in_b[i] < 0) return {1, 0};
    if (in_a[i] >= 0 && in_b[i] >= 0) continue;
    const double cut = in_a[i] / (in_a[i] - in_b[i]);
    if (in_a[i] < 0)
      part.from = std::max(part.from, cut);
    else
      part.to = std::min(part.to, cut);
  }
  return part;
}

ScreenPoint on_screen(const Clip& a, const Clip& b, double t, double width, double height) {
  const auto mixed = [&](std::size_t i) { return a[i] + t * (b[i] - a[i]); };
  return {(mixed(0) / mixed(3) * 0.5 + 0.5) * width, (mixed(1) / mixed(3) * 0.5 + 0.5) * height};
}

/// Points nearer than this many pixels to the one before have no direction worth following.
constexpr double kNearPixels = 0.05;

void append(std::vector<ScreenPoint>& points, const ScreenPoint& p) {
  if (points.empty() || std::hypot(p.x - points.back().x, p.y - points.back().y) > kNearPixels)
    points.push_back(p);
}

/// What is seen of a polyline. A closed one that is cut is begun after a cut, so that its runs do
/// not end where it does.
std::vector<Run> seen_runs(const std::vector<Clip>& points, bool closed, double width,
                           double height) {
  const std::size_t n = points.size(), segments = closed ? n : n - 1;
  std::vector<Part> parts(segments);
  std::size_t first = 0;
  bool cut = false;
  for (std::size_t i = 0; i < segments; ++i) {
    parts[i] = visible(points[i], points[(i + 1) % n]);
    if (closed && (parts[i].empty() || parts[i].to < 1)) first = (i + 1) % n, cut = true;
  }
  std::vector<Run> runs;
  bool goes_on = false;
  for (std::size_t k = 0; k < segments; ++k) {
    const std::size_t i = (first + k) % segments;
    const Clip &a = points[i], &b = points[(i + 1) % n];
    if (parts[i].empty()) {
      goes_on = false;
      continue;
    }
    if (!goes_on || parts[i].from > 0) runs.emplace_back();
    append(runs.back().points, on_screen(a, b, parts[i].from, width, height));
    append(runs.back().points, on_screen(a, b, parts[i].to, width, height));
    goes_on = parts[i].to >= 1;
  }
  if (closed && !cut && runs.size() == 1) runs[0].closed = true;
  return runs;
}

struct Direction {
  double x = 0, y = 0;
};

Direction direction(const ScreenPoint& a, const ScreenPoint& b) {
  const double length = std::max(std::hypot(b.x - a.x, b.y - a.y), 1e-9);
  return {(b.x - a.x) / length, (b.y - a.y) / length};
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0F, 1.0F)));
}

/// Lays a strip along a run: pairs of vertices to the left and right of its points.
class Strip {
 public:
  Strip(const LineStyle& style, LineMesh& out) : out_(out) {
    vertex_.half_width = static_cast<float>(style.width / 2);
    vertex_.halo = static_cast<float>(style.halo);
    for (std::size_t i = 0; i < 4; ++i) vertex_.color[i] = byte_of(style.color[i]);
    reach_ = style.width / 2 + style.halo + 1;  // a pixel in which it fades out
  }

  void lay(const Run& run) {
    const std::vector<ScreenPoint>& points = run.points;
    const std::size_t n = points.size();
    pairs_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool start = i == 0 && !run.closed, end = i + 1 == n && !run.closed;
      const ScreenPoint& at = points[i];
      const Direction in =
          start ? direction(at, points[i + 1]) : direction(points[(i + n - 1) % n], at);
      const Direction out = end ? in : direction(at, points[(i + 1) % n]);
      corner(at, in, out);
    }
    if (run.closed) close();
  }

 private:
  /// A mitre; round where the line turns so sharply that a mitre would be a thorn.
  void corner(const ScreenPoint& at, const Direction& in, const Direction& out) {
    const double turn = std::atan2(in.x * out.y - in.y * out.x, in.x * out.x + in.y * out.y);
    constexpr double kSharp = 1.75, kStep = 0.35;  // radians
    if (std::abs(turn) <= kSharp) {
      pair(at, in, turn / 2, 1 / std::cos(turn / 2));
      return;
    }
    const int steps = static_cast<int>(std::ceil(std::abs(turn) / kStep));
    for (int i = 0; i <= steps; ++i) pair(at, in, turn * i / steps, 1);
  }

  /// To the left and right of `along` turned by `angle`.
  void pair(const ScreenPoint& at, const Direction& along, double angle, double stretch) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double left_x = -(along.x * s + along.y * c), left_y = along.x * c - along.y * s;
    for (const double side : {1.0, -1.0}) {
      vertex_.x = static_cast<float>(at.x + side * stretch * reach_ * left_x);
      vertex_.y = static_cast<float>(at.y + side * stretch * reach_ * left_y);
      vertex_.across = static_cast<float>(side * reach_);
      out_.vertices.push_back(vertex_);
    }
    if (pairs_++ == 0)
      first_ = static_cast<std::uint32_t>(out_.vertices.size()) - 2;
    else
      join(static_cast<std::uint32_t>(out_.vertices.size()) - 4,
           static_cast<std::uint32_t>(out_.vertices.size()) - 2);
  }

  void close() { join(static_cast<std::uint32_t>(out_.vertices.size()) - 2, first_); }

  void join(std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) out_.indices.push_back(index);
  }

  LineMesh& out_;
  LineVertex vertex_;
  double reach_ = 0;
  std::uint32_t first_ = 0;
  int pairs_ = 0;
};

}  // namespace

void LineMesh::add(const Picture& picture, std::span<const protocol::MapPoint> points, bool closed,
                   double height, const LineStyle& style) {
  if (points.size() < 2) return;
  const scene::Mat4 clip_from_relative = picture.camera.clip_from_relative();
  const protocol::MapPoint& target = picture.camera.place().target;
  std::vector<Clip> clip;
  clip.reserve(points.size());
  for (const protocol::MapPoint& p : points)
    clip.push_back(clip_from_relative * scene::Vec3{p.x - target.x, p.y - target.y, height});
  Strip strip(style, *this);
  const scene::ScreenSize size = picture.camera.size();
  for (Run& run : seen_runs(clip, closed, size.width * picture.pixel_ratio,
                            size.height * picture.pixel_ratio)) {
    const ScreenPoint &front = run.points.front(), &back = run.points.back();
    if (run.closed && std::hypot(front.x - back.x, front.y - back.y) <= kNearPixels)
      run.points.pop_back();
    if (run.points.size() >= 2) strip.lay(run);
  }
}

}  // namespace earthwork::viewer::render
