#include "server/mesh/outline.hpp"

namespace earthwork::mesh {
namespace {

/// Goes around the rim counter-clockwise and links what has filled ground between.
class RimWalk {
 public:
  RimWalk(bool starts_filled, std::vector<std::uint16_t>& next)
      : filled_(starts_filled), next_(next) {}

  void corner(std::uint16_t point) {
    if (point != kNone) link(point);
  }
  void crossing(std::uint16_t point) {
    if (filled_) link(point);
    filled_ = !filled_;
    last_ = point;
  }
  void finish(std::uint16_t first_corner) {
    if (filled_) next_[last_] = first_corner;
  }

 private:
  void link(std::uint16_t point) {
    if (last_ != kNone) next_[last_] = point;
    last_ = point;
  }

  bool filled_;
  std::uint16_t last_ = kNone;
  std::vector<std::uint16_t>& next_;
};

void walk_rim(const ChunkCells& cells, const ContourGraph& graph,
              std::vector<std::uint16_t>& next) {
  const int height = cells.height();
  RimWalk rim(graph.corners[0] != kNone, next);
  rim.corner(graph.corners[0]);
  for (int id = cells.x_start(0); id < cells.x_start(1); ++id) {
    rim.crossing(static_cast<std::uint16_t>(id));
  }
  rim.corner(graph.corners[1]);
  for (int y = 0; y < height; ++y) {
    const int last = cells.y_start(y + 1) - cells.y_start(y) - 1;
    if (cells.last_column(y)) rim.crossing(ContourGraph::y_id(cells, y, last));
  }
  rim.corner(graph.corners[2]);
  for (int id = cells.x_start(height + 1) - 1; id >= cells.x_start(height); --id) {
    rim.crossing(static_cast<std::uint16_t>(id));
  }
  rim.corner(graph.corners[3]);
  for (int y = height - 1; y >= 0; --y) {
    if ((cells.y_mask(y) & 1) != 0) rim.crossing(ContourGraph::y_id(cells, y, 0));
  }
  rim.finish(graph.corners[0]);
}

}  // namespace

void link_outline(const ChunkCells& cells, const ContourGraph& graph,
                  const std::vector<Section>& sections, std::vector<std::uint16_t>& next) {
  next.assign(graph.points.size(), kNone);
  for (const Section& section : sections) next[section.a] = section.b;
  for (const ContourGraph::Ear& ear : graph.ears) {
    next[ear.from] = ear.to;
    next[ear.tip] = kNone;
  }
  walk_rim(cells, graph, next);
}

}  // namespace earthwork::mesh
