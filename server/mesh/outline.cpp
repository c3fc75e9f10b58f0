#include "server/mesh/outline.hpp"

#include "server/mesh/rim.hpp"

namespace earthwork::mesh {
namespace {

/// Links what has filled ground between, going around the rim counter-clockwise.
class RimLinks {
 public:
  RimLinks(const ContourGraph& graph, std::vector<std::uint16_t>& next)
      : graph_(graph), filled_(graph.corners[0] != kNone), next_(next) {}

  void corner(int k) {
    if (graph_.corners[k] != kNone) link(graph_.corners[k]);
  }
  void crossing(std::uint16_t point) {
    if (filled_) link(point);
    filled_ = !filled_;
    last_ = point;
  }
  void finish() {
    if (filled_) next_[last_] = graph_.corners[0];
  }

 private:
  void link(std::uint16_t point) {
    if (last_ != kNone) next_[last_] = point;
    last_ = point;
  }

  const ContourGraph& graph_;
  bool filled_;
  std::uint16_t last_ = kNone;
  std::vector<std::uint16_t>& next_;
};

}  // namespace

void link_outline(const ChunkCells& cells, const ContourGraph& graph,
                  const std::vector<Section>& sections, std::vector<std::uint16_t>& next) {
  next.assign(graph.points.size(), kNone);
  for (const Section& section : sections) next[section.a] = section.b;
  for (const ContourGraph::Ear& ear : graph.ears) {
    next[ear.from] = ear.to;
    next[ear.tip] = kNone;
  }
  RimLinks rim(graph, next);
  walk_rim(
      cells, [&](int k) { rim.corner(k); }, [&](std::uint16_t point) { rim.crossing(point); });
  rim.finish();
}

}  // namespace earthwork::mesh
