/// A map: layers of voxels in chunks, changed by stencils.
///
/// Only chunks that hold a filled voxel or a crossing are kept. One thread at a time, for reading
/// too while somebody writes; different maps are independent.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "server/voxel/change.hpp"
#include "server/voxel/chunk.hpp"
#include "server/voxel/chunk_edit.hpp"
#include "server/voxel/chunk_key.hpp"
#include "server/voxel/coverage.hpp"
#include "server/voxel/grid.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::voxel {

/// A chunk and the three neighbours that its cells reach into. A null chunk inside the bounds is
/// empty ground; beyond the bounds there are no cells at all. Pointers stay valid until the next
/// edit.
struct Neighbourhood {
  const Chunk* own = nullptr;
  const Chunk* right = nullptr;
  const Chunk* upper = nullptr;
  const Chunk* upper_right = nullptr;
  bool has_right = true;  ///< The column of chunks to the right is inside the bounds.
  bool has_upper = true;  ///< The row of chunks above is inside the bounds.
};

class Map {
 public:
  explicit Map(const Grid& grid) : grid_(grid) {}

  /// Its layers may become more or fewer; everything else stays.
  const Grid& grid() const { return grid_; }
  /// `layers` is 1 .. kMaxLayers. A new layer is empty; of one that goes, nothing is kept.
  void set_layers(int layers);

  /// Applies `stencils` in order to `layer` (0 .. layers - 1) and says what is different
  /// afterwards, as one change. The result is valid until the next call. What lies beyond the
  /// bounds is left out. GEOMETRY: "Stencils".
  const Change& apply(int layer, std::span<const Stencil> stencils);

  /// Replaces a chunk; a blank one is dropped. The caller answers for the crossings of the edges
  /// that it shares with its neighbours.
  void put(const ChunkKey& key, Chunk chunk);

  /// The chunk, or null when it holds nothing or lies beyond the bounds.
  const Chunk* find(const ChunkKey& key) const;
  Neighbourhood neighbourhood(const ChunkKey& key) const;
  /// Whether voxel (i, j) of the map is filled; beyond the bounds none is.
  bool filled(int layer, std::int32_t i, std::int32_t j) const;

  /// The keys of all chunks kept, in order.
  std::vector<ChunkKey> keys() const;
  /// The keys of all chunks that may have a mesh, in order: those kept, and the neighbours to
  /// their left, below and below left, inside the bounds.
  std::vector<ChunkKey> meshed_keys() const;
  std::size_t chunk_count() const { return chunks_.size(); }

  /// The sum over all kept chunks of XXH3 over (i32 layer, x, y, z, u64 chunk hash). Chunks changed
  /// since the last call are hashed now, no others.
  std::uint64_t hash();
  std::uint64_t filled_voxels() const;
  /// Bytes of memory held for voxels, bookkeeping included.
  std::size_t memory_bytes() const;

 private:
  struct Entry {
    explicit Entry(int resolution) : chunk(resolution) {}
    Chunk chunk;
    std::uint64_t term = 0;  // what the chunk adds to hash_
    bool stale = false;      // listed in stale_
  };

  void stamp(int layer, const Stencil& stencil);
  void stamp_chunk(const ChunkKey& key, const ChunkRect& extent);
  void note(const ChunkKey& key, const Touched& touched);
  void changed(const ChunkKey& key, Entry& entry);

  Grid grid_;
  std::unordered_map<ChunkKey, Entry, ChunkKeyHash> chunks_;
  std::vector<ChunkKey> stale_;
  std::uint64_t hash_ = 0;  // the sum of all terms
  Coverage coverage_;
  ChunkEdit edit_;
  Change change_;
};

}  // namespace earthwork::voxel
