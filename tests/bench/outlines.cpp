#include "tests/bench/outlines.hpp"

#include <algorithm>

#include "server/mesh/chunk_cells.hpp"
#include "server/mesh/contour_graph.hpp"
#include "server/mesh/outline.hpp"
#include "server/mesh/walls.hpp"
#include "tests/bench/map_mesh.hpp"

namespace earthwork::bench {
namespace {

// The steps of mesh::Mesher before it triangulates.
class OutlineMaker {
 public:
  Outline make(const mesh::ChunkCells& cells) {
    graph_.build(cells, mesh::sharpness_limit(kFeatureAngle));
    tracer_.trace(cells, graph_, sections_);
    mesh::link_outline(cells, graph_, sections_, next_);
    Outline outline;
    number_.resize(graph_.points.size());
    for (const std::uint16_t point : graph_.order) {
      if (tracer_.dropped()[point]) continue;
      number_[point] = static_cast<std::uint16_t>(outline.points.size());
      outline.points.push_back(graph_.points[point]);
    }
    for (const std::uint16_t point : graph_.order) {
      if (tracer_.dropped()[point]) continue;
      const std::uint16_t next = next_[point];
      outline.next.push_back(next == mesh::kNone ? mesh::kNone : number_[next]);
    }
    return outline;
  }

 private:
  mesh::ContourGraph graph_;
  mesh::WallTracer tracer_;
  std::vector<mesh::Section> sections_;
  std::vector<std::uint16_t> next_, number_;
};

}  // namespace

std::size_t Outline::vertices() const {
  return next.size() - static_cast<std::size_t>(std::count(next.begin(), next.end(), mesh::kNone));
}

std::vector<Outline> make_outlines(const voxel::Map& map, const MapSize& size) {
  std::vector<Outline> outlines;
  OutlineMaker maker;
  mesh::ChunkCells cells;
  for (int cy = 0; cy < size.chunks_y; ++cy) {
    for (int cx = 0; cx < size.chunks_x; ++cx) {
      cells.assign(map.neighbourhood({0, cx, cy, 0}), kBenchResolution);
      if (!cells.uniform()) outlines.push_back(maker.make(cells));
    }
  }
  return outlines;
}

}  // namespace earthwork::bench
