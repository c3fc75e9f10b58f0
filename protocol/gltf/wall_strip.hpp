/// The walls of a chunk as posts and panels: what two neighbouring sections share stands once.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

/// A vertical line of the wall, bottom to top: one normal for both of its ends.
struct WallPost {
  std::uint16_t vertex = 0;  ///< Of the chunk's mesh.
  MeshNormal normal;
  friend bool operator==(const WallPost&, const WallPost&) = default;
};

struct WallStrip {
  std::vector<WallPost> posts;
  /// A panel for each section, in order: the posts at its a and at its b.
  std::vector<std::array<std::uint32_t, 2>> panels;
};

/// Sections share a post where one ends and the next begins, and where a contour closes, when the
/// normals are equal too; at a crease there are two posts.
[[nodiscard]] WallStrip wall_strip(const ChunkMesh& mesh);

}  // namespace earthwork::protocol
