/// How long the chunks of a map have been as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "server/voxel/chunk_key.hpp"

namespace earthwork::journal {

/// Since when a chunk of the file is as it is, or is gone: it changed by no event after `seq`.
struct ChunkAge {
  voxel::ChunkKey key;
  std::uint64_t seq = 0;
  friend bool operator==(const ChunkAge&, const ChunkAge&) = default;
};

/// Of every chunk that ever held something.
class ChunkAges {
 public:
  void reserve(std::size_t chunks) { seqs_.reserve(chunks); }
  void set(const voxel::ChunkKey& key, std::uint64_t seq) { seqs_.insert_or_assign(key, seq); }
  void changed(std::span<const voxel::ChunkKey> keys, std::uint64_t seq) {
    for (const voxel::ChunkKey& key : keys) set(key, seq);
  }
  /// 0 for a chunk that never held anything.
  [[nodiscard]] std::uint64_t of(const voxel::ChunkKey& key) const {
    const auto found = seqs_.find(key);
    return found == seqs_.end() ? 0 : found->second;
  }
  [[nodiscard]] std::size_t size() const { return seqs_.size(); }
  [[nodiscard]] std::vector<ChunkAge> in_order() const;

 private:
  std::unordered_map<voxel::ChunkKey, std::uint64_t, voxel::ChunkKeyHash> seqs_;
};

}  // namespace earthwork::journal
