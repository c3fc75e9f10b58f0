/// The bytes of the voxel data that edits stand for, known from the protocol alone: what a server
/// that sends voxels rather than meshes would have to send.
#pragma once

#include <cstdint>
#include <vector>

#include "client/bot/load_walk.hpp"
#include "protocol/edit.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

/// Keeps the states of the painted square, empty at first, and a margin around it. For each edit
/// that changes a voxel, every chunk with a changed voxel counts as a whole: a bit a voxel, and 6
/// bytes a crossing (16 bits of position, a normal), of which there is one on each edge between
/// neighbours of different state; an edge is its lower left voxel's.
class VoxelBytes {
 public:
  /// Fits edits of layer 0 whose centres lie in the square and whose radius is at most `radius`.
  VoxelBytes(const protocol::MapSettings& settings, const PaintedSquare& square, double radius);

  /// The bytes that this edit stands for, after all before; circles only.
  [[nodiscard]] std::uint64_t add(const protocol::Edit& edit);

 private:
  bool at(std::int64_t x, std::int64_t y) const;
  std::uint64_t chunk_bytes(std::int64_t chunk_x, std::int64_t chunk_y) const;

  double voxel_size_;
  std::int64_t resolution_;
  std::int64_t x0_, y0_, width_, height_;  // voxels; multiples of the resolution
  std::vector<bool> states_;
};

/// The mean bytes an edit when so many walks with seeds `seed`, `seed` + 1 ... take turns, over the
/// first `edits` of all together; 0 of none.
[[nodiscard]] double mean_voxel_bytes(const protocol::MapSettings& settings,
                                      const PaintedSquare& square, double radius,
                                      std::uint64_t seed, std::size_t walks, std::uint64_t edits);

}  // namespace earthwork::bot
