#include "server/mesh/walls.hpp"

#include <cmath>

#include "server/mesh/rim.hpp"

namespace earthwork::mesh {

// The root of a sum of squares below 2^53 and one division: the same on every build.
voxel::Normal repaired(voxel::Normal normal, Point a, Point b) {
  const std::int64_t x = b.y - a.y, y = a.x - b.x;  // to the right of a -> b: outward
  if (normal.x * x + normal.y * y > 0) return normal;
  const double length = std::sqrt(static_cast<double>(x * x + y * y));
  const auto component = [length](std::int64_t v) {
    return static_cast<std::int16_t>(
        std::lround(static_cast<double>(voxel::kNormalUnit * v) / length));
  };
  return {component(x), component(y)};
}

void WallTracer::trace(const ChunkCells& cells, const ContourGraph& graph,
                       std::vector<Section>& sections) {
  sections.clear();
  sections_ = &sections;
  done_.assign(graph.to.size(), 0);
  dropped_.assign(graph.points.size(), 0);
  walk_rim(
      cells, [](int) {},
      [&](std::uint16_t point) {
        if (graph.to[point] != kNone) trace_from(graph, point);
      });
  for (const std::uint16_t point : graph.order) {
    if (point < done_.size() && !done_[point] && graph.to[point] != kNone) trace_from(graph, point);
  }
}

void WallTracer::trace_from(const ContourGraph& graph, std::uint16_t start) {
  first_ = sections_->size();
  std::uint16_t at = start;
  do {
    done_[at] = 1;
    const std::uint16_t to = graph.to[at], tip = graph.feature[at];
    const voxel::Normal here = graph.normals[at], there = graph.normals[to];
    if (tip == kNone) {
      add(graph, {at, to, here, there});
    } else {
      add(graph, {at, tip, here, here});
      add(graph, {tip, to, there, there});
    }
    at = to;
  } while (at != start && graph.to[at] != kNone);
  if (at == start) close(graph);
}

void WallTracer::add(const ContourGraph& graph, Section section) {
  const Point a = graph.points[section.a], b = graph.points[section.b];
  section.normal_a = repaired(section.normal_a, a, b);
  section.normal_b = repaired(section.normal_b, a, b);
  if (sections_->size() > first_ && straight(graph, sections_->back(), section)) {
    dropped_[section.a] = 1;
    sections_->back().b = section.b;
  } else {
    sections_->push_back(section);
  }
}

// The end of a closed contour may go straight on into its start.
void WallTracer::close(const ContourGraph& graph) {
  Section &first = (*sections_)[first_], &last = sections_->back();
  if (!straight(graph, last, first)) return;
  dropped_[first.a] = 1;
  first.a = last.a;
  sections_->pop_back();
}

bool WallTracer::straight(const ContourGraph& graph, const Section& before, const Section& after) {
  const bool one_normal = before.normal_a == before.normal_b && before.normal_b == after.normal_a &&
                          after.normal_a == after.normal_b;
  if (!one_normal) return false;
  if (after.a < graph.fixed.size() && graph.fixed[after.a]) return false;
  const Point a = graph.points[before.a], b = graph.points[after.a], c = graph.points[after.b];
  const std::int64_t ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
  return ux * vy == uy * vx;
}

}  // namespace earthwork::mesh
