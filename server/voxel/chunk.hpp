/// One chunk of one layer: which voxels are filled, and where the contour crosses the edges that
/// leave them toward +x and +y.
///
/// States are one bit a voxel, a 64-bit word a row. An edge with a crossing has a bit in a mask of
/// the same shape, and the crossings lie packed in row order, so one is found by counting bits. A
/// chunk without crossings, whose voxels are then all alike, has no body at all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "server/voxel/copy_on_write.hpp"
#include "server/voxel/crossing.hpp"
#include "server/voxel/grid.hpp"

namespace earthwork::voxel {

/// Word j is row j, bit i of it column i. What lies beyond the resolution is 0.
using Rows = std::array<std::uint64_t, kMaxResolution>;

/// The direction of an edge, from the voxel that it belongs to.
enum class Axis : std::uint8_t { x, y };

/// A chunk taken apart. `x` has a crossing for every bit of `x_masks`, row by row and left to right
/// in a row; `y` likewise. A mask has a bit wherever the edge's ends differ, and nowhere else; the
/// ends of edges in the last row and column belong to neighbours.
struct ChunkParts {
  int resolution = 32;
  Rows rows{}, x_masks{}, y_masks{};
  std::vector<Crossing> x, y;
};

/// Copies share the body until one of them is edited, which copies it first; see CopyOnWrite for
/// what different threads may do with them.
class Chunk {
 public:
  /// All voxels empty, no crossings. `resolution` is 8, 16, 32 or 64.
  explicit Chunk(int resolution) : resolution_(static_cast<std::uint8_t>(resolution)) {}
  static Chunk assemble(const ChunkParts& parts);

  int resolution() const { return resolution_; }
  /// No crossings, and all voxels alike.
  bool uniform() const { return !body_; }
  /// Neither a filled voxel nor a crossing: a map does not keep such a chunk.
  bool blank() const { return !body_ && !full_; }

  bool filled(int x, int y) const { return (row(y) >> x & 1) != 0; }
  /// The states of row `y`.
  std::uint64_t row(int y) const { return body_ ? body_->words[at(y)] : full_ ? full_row() : 0; }
  /// Which edges of row `y` have a crossing; bit x is the edge that leaves voxel (x, y).
  std::uint64_t mask(Axis axis, int y) const {
    return body_ ? body_->words[at(y) + mask_offset(axis)] : 0;
  }
  /// The crossings of row `y`, left to right. Valid until the chunk changes.
  std::span<const Crossing> crossings(Axis axis, int y) const;
  /// All crossings along `axis`, row by row.
  std::span<const Crossing> crossings(Axis axis) const;
  int crossing_count(Axis axis, int y) const {
    if (!body_) return 0;
    const std::uint16_t* start = body_->starts.data() + start_offset(axis) + at(y);
    return start[1] - start[0];
  }
  /// A word with a bit for each voxel of a row.
  std::uint64_t full_row() const { return ~std::uint64_t{0} >> (kMaxResolution - resolution_); }

  int filled_voxels() const;
  int crossing_count() const;
  /// XXH3-64 over the chunk's canonical bytes: u32 resolution; a u64 a row; the x crossings, then
  /// the y crossings, each u16 offset, i16 nx, i16 ny; all little-endian.
  std::uint64_t hash() const;
  /// Bytes on the heap, counted for each copy that shares them.
  std::size_t body_bytes() const;

 private:
  friend class ChunkEdit;

  struct Body {
    std::vector<std::uint64_t> words;   // the rows, then the x masks, then the y masks
    std::vector<std::uint16_t> starts;  // where a row's crossings begin: x rows and the end, then y
    std::vector<Crossing> packed[2];    // x, y
  };

  static std::size_t at(int y) { return static_cast<std::size_t>(y); }
  std::size_t mask_offset(Axis axis) const {
    return axis == Axis::x ? resolution_ : std::size_t{2} * resolution_;
  }
  std::size_t start_offset(Axis axis) const {
    return axis == Axis::x ? 0 : std::size_t{1} + resolution_;
  }

  CopyOnWrite<Body> body_;  // none when uniform
  std::uint8_t resolution_;
  bool full_ = false;  // what a uniform chunk is
};

}  // namespace earthwork::voxel
