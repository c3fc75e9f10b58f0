/// Constants of the delta record's bytes, and the view of a wall, that its two sides share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "protocol/open_edges.hpp"
#include "protocol/wall_guess.hpp"

namespace earthwork::protocol {

inline constexpr std::uint8_t kRecordDelta = 3;  ///< First byte of the body.

/// A new section's varint: bit 0, bits 1 and 2, 3 and 4, 5 and 6.
enum class SectionStart : std::uint8_t { goes_on, given };
enum class SectionEnd : std::uint8_t { on_row, on_column, beside, known };
enum class StartNormal : std::uint8_t { goes_on, coded, next_copy };
enum class EndNormal : std::uint8_t { same, coded, next_copy };
inline constexpr std::uint32_t kSectionHeadEnd = 1u << 8;
/// Of a known end: whether it is given, or is where the next copied section starts.
inline constexpr std::uint32_t kEndIsGiven = 1u << 7;

/// Lowest bits of a vertex's varint; what is above them:
enum class Reference : std::uint8_t {
  base,     ///< Step from the base vertex named before.
  added,    ///< Which of the new vertices.
  position  ///< x of a new vertex; y follows.
};
inline constexpr int kReferenceBits = 2;

/// A normal is one byte, 16 * zigzag(x - guess) + zigzag(y - guess), or 0xF0 and two i16.
inline constexpr std::uint32_t kNormalStepEnd = 15;
inline constexpr std::uint8_t kNormalFollows = 0xF0;

/// Of a run of triangles: 16 * copied + 4 * skipped + added; 3 means that 3 + a varint are.
inline constexpr std::uint32_t kManyTriangles = 3;
/// Of a triangle of which each corner is said: two bits a corner above the form's, the same as that
/// corner of the triangle before, or a step follows.
inline constexpr std::uint32_t kCornerFollows = 3;
inline constexpr int kFormBits = 2, kCornersBits = 6;

/// In place of a vertex: there is none.
inline constexpr std::uint32_t kNoVertex = OpenEdges::kNone;

/// Vertices by y and then x, none twice.
inline bool precedes(MeshPoint a, MeshPoint b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// A section while vertices have no numbers yet: those of the base are 0 .. 65534, new ones follow
/// from kFirstAdded on.
struct OpenSection {
  std::uint32_t a = 0, b = 0;
  MeshNormal normal_a, normal_b;
};
inline constexpr std::uint32_t kFirstAdded = 0x10000;

/// The wall after the section from `a` to `b`.
inline WallEnd end_of(MeshPoint a, MeshPoint b, MeshNormal normal_a, MeshNormal normal_b) {
  WallEnd end{.at = b, .normal = normal_b, .bend = {}};
  if (normal_a != normal_b) end.bend = WallEnd::Bend{.from = a, .normal = normal_a};
  return end;
}

}  // namespace earthwork::protocol
