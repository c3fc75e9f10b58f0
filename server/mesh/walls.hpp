/// Walls: a contour's pieces as sections with normals, straight runs joined.
#pragma once

#include <cstdint>
#include <vector>

#include "server/mesh/contour_graph.hpp"

namespace earthwork::mesh {

/// Traces the contours of a chunk. Those that enter it over the rim come first, in the order of
/// their first points around it, counter-clockwise from the lower left; then the closed ones, in
/// the order of their lowest crossing (by y, then x).
class WallTracer {
 public:
  /// Replaces `sections`, whose ends are points of `graph`. Two sections on one line whose four
  /// normals are equal are joined; the point between them is set in dropped().
  void trace(const ChunkCells& cells, const ContourGraph& graph, std::vector<Section>& sections);
  /// A flag for each point of the graph: no section ends there any more.
  const std::vector<std::uint8_t>& dropped() const { return dropped_; }

 private:
  void trace_from(const ContourGraph& graph, std::uint16_t start);
  void add(const ContourGraph& graph, Section section);
  void close(const ContourGraph& graph);
  static bool straight(const ContourGraph& graph, const Section& before, const Section& after);

  std::vector<Section>* sections_ = nullptr;
  std::size_t first_ = 0;  // section of the contour being traced
  std::vector<std::uint8_t> done_, dropped_;
};

/// `normal`, or the normal of the section from `a` to `b` where `normal` points against it.
voxel::Normal repaired(voxel::Normal normal, Point a, Point b);

}  // namespace earthwork::mesh
