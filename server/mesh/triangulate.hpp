/// Triangles for the ground inside an outline, without a vertex more than the outline has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "server/mesh/chunk_mesh.hpp"

namespace earthwork::mesh {

/// Cuts polygons with holes into exactly n + 2h - 2 triangles a polygon of n vertices (its holes'
/// counted) and h holes, in one sweep. Exact: every test is a sign of integers.
///
/// Between two neighbouring edges that the sweep line cuts, a chain of vertices bounds what is not
/// triangulated yet; it bends away from the open ground at every inner vertex, so that a new vertex
/// sees a run of it from its end, or all of it.
/// Source: Hertel, Mehlhorn, "Fast triangulation of the plane with respect to simple polygons"
/// (1985).
///
/// Keeps scratch memory only. One thread at a time.
class Triangulator {
 public:
  /// Appends three indices a triangle to `triangles`, counter-clockwise.
  ///
  /// `points` are ordered by y and then x, all different, at most 65,534, coordinates below 2^30.
  /// `next[v]` is the vertex that follows v on its outline, filled ground on the left, or kNone for
  /// a point that is on none. Edges do not touch or cross except at shared ends. Three points in a
  /// row may lie on a line; a triangle never has no area.
  void run(std::span<const Point> points, std::span<const std::uint16_t> next,
           std::vector<std::uint16_t>& triangles);

 private:
  using Index = std::uint32_t;  // of a node or an interval
  static constexpr Index kNil = 0xFFFFFFFF;

  struct Node {
    std::uint16_t vertex;
    Index before, after;  // in the chain, left to right; kNil at its ends
  };
  /// The open ground between a left and a right edge. Their lower ends are the chain's ends.
  struct Interval {
    Index head, tail, peak;  // nodes: left end, right end, highest
    Index before, after;     // intervals to the left and right, kNil at the ends
  };

  void visit(std::uint16_t v);
  void start(std::uint16_t v);
  void split(std::uint16_t v, Index interval);
  void merge(std::uint16_t v, Index left, Index right);
  void close(std::uint16_t v, Index interval);

  void push_right(Interval& interval, std::uint16_t v);
  void push_left(Interval& interval, std::uint16_t v);
  Index locate(std::uint16_t v, bool& inside);
  Index new_interval(Index before);
  void remove_interval(Index interval);
  Index new_node(std::uint16_t v);
  std::int64_t turn(std::uint16_t a, std::uint16_t b, std::uint16_t c) const;
  void emit(std::uint16_t a, std::uint16_t b, std::uint16_t c);

  std::span<const Point> points_;
  std::span<const std::uint16_t> next_;
  std::vector<std::uint16_t>* triangles_ = nullptr;
  std::vector<std::uint16_t> previous_;
  std::vector<Index> left_of_, right_of_;  // interval whose left, right edge starts at v
  std::vector<Node> nodes_;
  std::vector<Interval> intervals_;
  Index first_ = kNil;  // the leftmost interval
  Index hint_ = kNil;   // where the sweep was last
};

}  // namespace earthwork::mesh
