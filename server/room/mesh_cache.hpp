/// The meshes of one map, encoded, as of one seq: made when somebody first needs them, and again
/// when an edit has touched their cells. Everything here can be made anew from the voxels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "server/journal/chunk_ages.hpp"
#include "server/room/mesh_record.hpp"
#include "server/voxel/chunk_key.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// Over all chunks that have a mesh.
struct MeshTotals {
  std::uint64_t hash = 0;
  std::size_t chunks = 0, triangles = 0, vertices = 0, bytes = 0;
  friend bool operator==(const MeshTotals&, const MeshTotals&) = default;
};

/// What a chunk's next mesh comes after, and is told as.
struct Forerunner {
  std::optional<CachedMesh> mesh;  ///< The last one; none when there was none, or none is known.
  bool seen_unknown = false;       ///< Before the start viewers may have got one.
  std::uint64_t revision = 0;      ///< Of the next mesh, if it is another one.
};

/// Holds at most one encoded record for each chunk of the map that has or had a mesh. Starts as
/// that of an empty map. One thread at a time.
class MeshCache {
 public:
  /// Begins with a map that was there before: meshes that are not known here may have been seen,
  /// each as of a seq up to the age of the chunks that its cells reach into. No mesh is made. On a
  /// cache that holds nothing; `ages` name all chunks of `map` and those that are gone.
  void restore(const voxel::Map& map, std::span<const journal::ChunkAge> ages);

  /// The cells of these chunks are different now.
  void mark_stale(std::span<const voxel::ChunkKey> keys);
  /// For a mesh that is made as of `seq`: whoever makes it takes its revision from here. A chunk
  /// that no edit has touched since the start has an older one, so that who saw its mesh before
  /// the start is not sent it again.
  [[nodiscard]] Forerunner forerunner(const voxel::ChunkKey& key, std::uint64_t seq) const;
  /// The chunk has what it had before, and is stale: the mesh that was put after `before` was never
  /// shown, because what it was made of was taken back.
  void take_back(const voxel::ChunkKey& key, Forerunner before);
  /// What `find` gives is not the chunk's mesh.
  [[nodiscard]] bool stale(const voxel::ChunkKey& key) const { return stale_.contains(key); }
  /// The mesh that the chunk had last; null when it never had one. Valid until it is put.
  [[nodiscard]] const CachedMesh* find(const voxel::ChunkKey& key) const;
  /// The chunk's mesh is `made` now, or what it was when that is nothing.
  void put(const voxel::ChunkKey& key, std::optional<CachedMesh> made);

  [[nodiscard]] std::size_t stale_count() const { return stale_.size(); }
  /// Of those, the ones that an edit has touched: not the ones that only were never made.
  [[nodiscard]] std::size_t dirty_count() const { return dirty_; }
  /// Up to `most` stale chunks, any.
  [[nodiscard]] std::vector<voxel::ChunkKey> some_stale(std::size_t most) const;

  /// It has a mesh, or may have one.
  [[nodiscard]] bool may_have_mesh(const voxel::ChunkKey& key) const;
  /// Every chunk that `may_have_mesh`, and those whose mesh was removed, here or before the start;
  /// in order.
  [[nodiscard]] std::vector<voxel::ChunkKey> keys() const;
  /// `keys` names it.
  [[nodiscard]] bool knows(const voxel::ChunkKey& key) const {
    return stale_.contains(key) || meshes_.contains(key);
  }
  /// How many chunks `may_have_mesh`.
  [[nodiscard]] std::size_t count() const { return totals_.chunks + without_mesh_; }

  /// True figures only when nothing is stale.
  [[nodiscard]] const MeshTotals& totals() const { return totals_; }
  /// The records of all chunks that have a mesh, in order of their keys. As of one seq only when
  /// nothing is stale.
  [[nodiscard]] std::vector<RecordBytes> records() const;

 private:
  struct Stale {
    std::uint64_t revision = 0;  // of its next mesh; 0: the seq as of which that is made
    bool seen_unknown = false;
    bool bare = false;          // nothing that its cells reach into is filled: it has no mesh
    bool without_mesh = false;  // counted there
  };

  using StaleOnes = std::unordered_map<voxel::ChunkKey, Stale, voxel::ChunkKeyHash>;

  void touch(const voxel::ChunkKey& key);
  void forget_stale(StaleOnes::iterator place);
  void replace(const voxel::ChunkKey& key, std::optional<CachedMesh> mesh);

  std::map<voxel::ChunkKey, CachedMesh> meshes_;
  StaleOnes stale_;
  std::size_t without_mesh_ = 0;  // of the stale ones: have no mesh now, and may have one
  std::size_t dirty_ = 0;         // of the stale ones: their revision is 0
  MeshTotals totals_;
};

}  // namespace earthwork::room
