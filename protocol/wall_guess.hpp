/// Guesses of where a wall goes on and what its normals are, so that a delta carries only how far
/// off they are. Both sides must guess alike: sums, products, quotients and roots of doubles, which
/// every machine rounds in one way, and floor.
#pragma once

#include <cstdint>
#include <optional>

#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

/// The end of the wall so far: where it is, its normal there, and the section that led there, if
/// that was bent.
struct WallEnd {
  MeshPoint at;
  MeshNormal normal;
  struct Bend {
    MeshPoint from;
    MeshNormal normal;
  };
  std::optional<Bend> bend;
};

enum class GridLine : std::uint8_t { row, column };  ///< Of constant y, of constant x.

/// The grid line through voxel centres next to `at`, ahead as seen along the wall, or behind.
/// It may lie outside the chunk.
std::int32_t line_beside(const WallEnd& end, GridLine line, bool behind);
/// Where the wall meets that line: x on a row, y on a column. Within +-2^23.
std::int32_t guess_on_line(const WallEnd& end, GridLine line, std::int32_t position);
/// How far the wall is from its tangent's y after going by dx (`by_x`), or x after going by dy.
std::int32_t guess_beside(const WallEnd& end, bool by_x, std::int32_t step);
/// Whether the tangent runs along x more than along y.
bool runs_along_x(MeshNormal normal);

/// The normal of the straight section from a to b, which are different.
MeshNormal straight_normal(MeshPoint a, MeshPoint b);
/// The normal at b of a circle through a and b whose normal at a is `at_a`.
MeshNormal round_normal(MeshPoint a, MeshPoint b, MeshNormal at_a);

}  // namespace earthwork::protocol
