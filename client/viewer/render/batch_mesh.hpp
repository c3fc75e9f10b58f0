/// The meshes of neighbouring chunks of one layer as one list of triangles: what the graphics card
/// is handed, so that a full view takes hundreds of calls and not tens of thousands.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/scene/scene.hpp"
#include "protocol/chunk_record.hpp"

namespace earthwork::viewer::render {

/// Voxels along a batch's side. A position in it, in 1/32768 voxel, takes 24 bits: a 32-bit float
/// holds it exactly.
inline constexpr int kBatchVoxels = 256;

/// Which batch of which layer, counted in batches.
struct BatchKey {
  std::int32_t layer = 0, x = 0, y = 0;
  friend auto operator<=>(const BatchKey&, const BatchKey&) = default;
};

/// The batch that a chunk of `resolution` voxels is in.
[[nodiscard]] BatchKey batch_of(const protocol::ChunkKey& chunk, int resolution);

/// A corner of a surface or of a wall.
struct BatchVertex {
  float x = 0, y = 0;           ///< Voxels from the batch's lower left corner; exact.
  protocol::MeshNormal normal;  ///< Of a wall; (0, 0) on a surface.
  std::int16_t top = 0;         ///< 1 at the layer's top, 0 at its bottom.
  std::int16_t wall = 0;        ///< 1 on a wall, 0 on a surface.
  friend bool operator==(const BatchVertex&, const BatchVertex&) = default;
};

/// Triangles counter-clockwise seen from outside: surfaces first, then walls.
struct BatchMesh {
  std::vector<BatchVertex> vertices;
  std::vector<std::uint32_t> indices;

  /// What the scene has of that batch now, in memory that is used again.
  void rebuild(const scene::Scene::Chunks& chunks, const BatchKey& batch, int resolution);
};

}  // namespace earthwork::viewer::render
