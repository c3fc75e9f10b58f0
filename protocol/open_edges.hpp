/// The edges of the ground that wait for a triangle on their left, as triangles are put in one by
/// one: a sweep's next triangle mostly closes two of them, so its highest corner says the others.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

/// Of one edge into a vertex and one out of it, the latest, where there are more. Only a guess
/// comes of this, so what is forgotten costs bytes and nothing else.
class OpenEdges {
 public:
  using Corners = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t kNone = 0xFFFF'FFFF;

  /// At first each section of the mesh is one, for the ground lies on its left.
  explicit OpenEdges(const ChunkMesh& mesh)
      : into_(mesh.vertices.size(), kNone), out_of_(mesh.vertices.size(), kNone) {
    for (const WallSection& section : mesh.sections) open(section.a, section.b);
  }

  void put(const Corners& corners) {
    bool closed[3];
    for (std::size_t i = 0; i < 3; ++i) closed[i] = close(corners[i], corners[(i + 1) % 3]);
    for (std::size_t i = 0; i < 3; ++i)
      if (!closed[i]) open(corners[(i + 1) % 3], corners[i]);
  }

  /// The other end of the edge into `vertex`, and of the one out of it; kNone of kNone.
  [[nodiscard]] std::uint32_t into(std::uint32_t vertex) const { return at(into_, vertex); }
  [[nodiscard]] std::uint32_t out_of(std::uint32_t vertex) const { return at(out_of_, vertex); }

 private:
  void open(std::uint32_t a, std::uint32_t b) {
    out_of_[a] = b;
    into_[b] = a;
  }
  bool close(std::uint32_t a, std::uint32_t b) {
    if (out_of_[a] != b || into_[b] != a) return false;
    out_of_[a] = into_[b] = kNone;
    return true;
  }
  static std::uint32_t at(const std::vector<std::uint32_t>& ends, std::uint32_t vertex) {
    return vertex == kNone ? kNone : ends[vertex];
  }

  std::vector<std::uint32_t> into_, out_of_;
};

/// How a new triangle stands to its highest corner, in the two lowest bits of its varint.
enum class TriangleForm : std::uint8_t {
  into_it,    ///< The two edges into it, one after the other: (.., .., v).
  out_of_it,  ///< The two edges out of it: (v, .., ..).
  closing,    ///< The two edges out of it, and v comes last.
  corners     ///< Each corner is said.
};

/// The triangle of the first three forms; kNone where there is no such edge.
inline OpenEdges::Corners triangle_at(const OpenEdges& edges, TriangleForm form, std::uint32_t v) {
  const bool into = form == TriangleForm::into_it;
  const std::uint32_t first = into ? edges.into(v) : edges.out_of(v);
  const std::uint32_t second = into ? edges.into(first) : edges.out_of(first);
  if (into) return {second, first, v};
  if (form == TriangleForm::out_of_it) return {v, first, second};
  return {first, second, v};
}

}  // namespace earthwork::protocol
