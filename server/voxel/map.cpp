#include "server/voxel/map.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace earthwork::voxel {
namespace {

std::uint64_t hash_term(const ChunkKey& key, std::uint64_t chunk_hash) {
  unsigned char bytes[24];
  static_assert(sizeof key == 16);
  std::memcpy(bytes, &key, 16);
  std::memcpy(bytes + 16, &chunk_hash, 8);
  return XXH3_64bits(bytes, sizeof bytes);
}

}  // namespace

void Map::set_layers(int layers) {
  assert(1 <= layers && layers <= kMaxLayers);
  for (auto next = chunks_.begin(); next != chunks_.end();) {
    const auto chunk = next++;
    if (chunk->first.layer < layers) continue;
    hash_ -= chunk->second.term;
    chunks_.erase(chunk);
  }
  grid_.layers = layers;
}

const Change& Map::apply(int layer, std::span<const Stencil> stencils) {
  assert(layer >= 0 && layer < grid_.layers);
  change_.clear();
  for (const Stencil& stencil : stencils) stamp(layer, stencil);
  put_in_order(change_);
  return change_;
}

// Top right to bottom left: a chunk's last edges lead to voxels of its right and upper neighbours,
// which are then already what they become.
void Map::stamp(int layer, const Stencil& stencil) {
  coverage_.assign(stencil, grid_.voxel_size);
  if (coverage_.empty()) return;
  const ChunkRect extent = grid_.extent();
  const std::int32_t x0 = std::max(grid_.chunk_of(coverage_.left() - 1), extent.x0);
  const std::int32_t y0 = std::max(grid_.chunk_of(coverage_.bottom() - 1), extent.y0);
  const std::int32_t x1 = std::min(grid_.chunk_of(coverage_.right()), extent.x1 - 1);
  const std::int32_t y1 = std::min(grid_.chunk_of(coverage_.top()), extent.y1 - 1);
  for (std::int32_t y = y1; y >= y0; --y) {
    for (std::int32_t x = x1; x >= x0; --x) stamp_chunk({layer, x, y, 0}, extent);
  }
}

void Map::stamp_chunk(const ChunkKey& key, const ChunkRect& extent) {
  auto found = chunks_.find(key);
  if (found == chunks_.end()) {
    if (coverage_.fill() == Fill::empty) return;
    found = chunks_.try_emplace(key, grid_.resolution).first;
  }
  Entry& entry = found->second;
  const int resolution = grid_.resolution;
  const ChunkPlace place{.x = key.x * resolution,
                         .y = key.y * resolution,
                         .has_right = key.x + 1 < extent.x1,
                         .has_upper = key.y + 1 < extent.y1,
                         .right = find({key.layer, key.x + 1, key.y, 0}),
                         .upper = find({key.layer, key.x, key.y + 1, 0})};
  const Touched touched = edit_.apply(coverage_, place, entry.chunk);
  if (touched.chunk) {
    note(key, touched);
    changed(key, entry);
  }
  if (entry.chunk.blank()) {
    hash_ -= entry.term;
    chunks_.erase(found);
  }
}

void Map::changed(const ChunkKey& key, Entry& entry) {
  change_.changed.push_back(key);
  if (entry.stale) return;
  entry.stale = true;
  stale_.push_back(key);
}

void Map::note(const ChunkKey& key, const Touched& touched) {
  const ChunkRect extent = grid_.extent();
  const auto add = [&](std::int32_t dx, std::int32_t dy, const CellRect& cells) {
    if (cells.empty() || !extent.contains(key.x + dx, key.y + dy)) return;
    change_.dirty.push_back({{key.layer, key.x + dx, key.y + dy, key.z}, cells});
  };
  add(0, 0, touched.own);
  add(-1, 0, touched.left);
  add(0, -1, touched.lower);
  add(-1, -1, touched.lower_left);
}

void Map::put(const ChunkKey& key, Chunk chunk) {
  assert(chunk.resolution() == grid_.resolution && grid_.extent().contains(key.x, key.y));
  const auto found = chunks_.try_emplace(key, grid_.resolution).first;
  Entry& entry = found->second;
  if (chunk.blank()) {
    hash_ -= entry.term;
    chunks_.erase(found);
    return;
  }
  entry.chunk = std::move(chunk);
  if (!entry.stale) stale_.push_back(key);
  entry.stale = true;
}

const Chunk* Map::find(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  return found == chunks_.end() ? nullptr : &found->second.chunk;
}

Neighbourhood Map::neighbourhood(const ChunkKey& key) const {
  const ChunkRect extent = grid_.extent();
  return {.own = find(key),
          .right = find({key.layer, key.x + 1, key.y, key.z}),
          .upper = find({key.layer, key.x, key.y + 1, key.z}),
          .upper_right = find({key.layer, key.x + 1, key.y + 1, key.z}),
          .has_right = key.x + 1 < extent.x1,
          .has_upper = key.y + 1 < extent.y1};
}

bool Map::filled(int layer, std::int32_t i, std::int32_t j) const {
  const int r = grid_.resolution;
  const ChunkKey key{layer, grid_.chunk_of(i), grid_.chunk_of(j), 0};
  const Chunk* chunk = find(key);
  return chunk && chunk->filled(i - key.x * r, j - key.y * r);
}

std::vector<ChunkKey> Map::keys() const {
  std::vector<ChunkKey> keys;
  keys.reserve(chunks_.size());
  for (const auto& [key, entry] : chunks_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::vector<ChunkKey> Map::meshed_keys() const {
  const ChunkRect extent = grid_.extent();
  std::vector<ChunkKey> keys;
  keys.reserve(4 * chunks_.size());
  for (const auto& [key, entry] : chunks_) {
    for (const auto& [dx, dy] : {std::pair{0, 0}, {-1, 0}, {0, -1}, {-1, -1}}) {
      if (extent.contains(key.x + dx, key.y + dy)) {
        keys.push_back({key.layer, key.x + dx, key.y + dy, key.z});
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

std::uint64_t Map::hash() {
  for (const ChunkKey& key : stale_) {
    const auto found = chunks_.find(key);
    if (found == chunks_.end() || !found->second.stale) continue;
    Entry& entry = found->second;
    hash_ -= entry.term;
    entry.term = hash_term(key, entry.chunk.hash());
    hash_ += entry.term;
    entry.stale = false;
  }
  stale_.clear();
  return hash_;
}

// Sums of integers: the order in which the chunks come does not show.
std::uint64_t Map::filled_voxels() const {
  std::uint64_t count = 0;
  for (const auto& [key, entry] : chunks_) {
    count += static_cast<std::uint64_t>(entry.chunk.filled_voxels());
  }
  return count;
}

std::size_t Map::memory_bytes() const {
  constexpr std::size_t kNode = sizeof(std::pair<const ChunkKey, Entry>) + 2 * sizeof(void*);
  std::size_t bytes = sizeof *this + chunks_.bucket_count() * sizeof(void*);
  for (const auto& [key, entry] : chunks_) bytes += kNode + entry.chunk.body_bytes();
  return bytes;
}

}  // namespace earthwork::voxel
