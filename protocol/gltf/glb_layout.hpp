/// Where every chunk's vertices and indices lie in the binary part of a GLB file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/gltf/glb.hpp"

namespace earthwork::protocol {

using Float3 = std::array<float, 3>;

/// A vertex is 24 bytes: position and normal, three float32 each.
inline constexpr std::size_t kGlbVertexBytes = 24;

/// One primitive: vertices, then indices of two bytes or, beyond 65,535 vertices, of four.
struct PrimitiveLayout {
  std::size_t vertices = 0, indices = 0;
  std::size_t vertex_offset = 0, index_offset = 0;  ///< In bytes, multiples of four.
  Float3 min{}, max{};                              ///< Of the positions, exactly.
  [[nodiscard]] std::size_t index_bytes() const { return vertices > 65535 ? 4 : 2; }
  [[nodiscard]] std::size_t end() const { return index_offset + indices * index_bytes(); }
};

struct ChunkLayout {
  ChunkKey key;
  const ChunkMesh* mesh = nullptr;
  std::optional<PrimitiveLayout> surface, wall;
};

struct GlbLayout {
  std::vector<ChunkLayout> chunks;  ///< In the order of their keys; those without a mesh left out.
  std::uint64_t bytes = 0;          ///< Of the binary part, a multiple of four.
};

[[nodiscard]] GlbLayout glb_layout(const MapSettings& settings, const MeshMap& meshes);

/// A point of a chunk in glTF's axes, relative to the chunk's origin: map x is X, height is Y, map
/// y is -Z. Rounded to float32 once.
[[nodiscard]] Float3 glb_position(MeshPoint point, double height, double voxel_size);
/// A stored normal as a unit vector in glTF's axes.
[[nodiscard]] Float3 glb_normal(MeshNormal normal);

}  // namespace earthwork::protocol
