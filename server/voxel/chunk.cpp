#include "server/voxel/chunk.hpp"

#include <bit>
#include <cassert>
#include <cstring>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace earthwork::voxel {

static_assert(std::endian::native == std::endian::little, "stored bytes are memory's bytes");
static_assert(sizeof(Crossing) == 6, "a crossing is hashed as it lies in memory");

Chunk Chunk::assemble(const ChunkParts& parts) {
  Chunk chunk(parts.resolution);
  if (parts.x.empty() && parts.y.empty()) {
    chunk.full_ = parts.rows[0] != 0;
    return chunk;
  }
  Body body;
  for (const Rows* words : {&parts.rows, &parts.x_masks, &parts.y_masks}) {
    body.words.insert(body.words.end(), words->begin(), words->begin() + parts.resolution);
  }
  for (const Rows* masks : {&parts.x_masks, &parts.y_masks}) {
    int start = 0;
    for (int y = 0; y <= parts.resolution; ++y) {
      body.starts.push_back(static_cast<std::uint16_t>(start));
      if (y < parts.resolution) start += std::popcount((*masks)[at(y)]);
    }
  }
  assert(body.starts[at(parts.resolution)] == parts.x.size());
  assert(body.starts.back() == parts.y.size());
  body.packed[0] = parts.x;
  body.packed[1] = parts.y;
  chunk.body_ = CopyOnWrite<Body>(std::move(body));
  return chunk;
}

std::span<const Crossing> Chunk::crossings(Axis axis, int y) const {
  if (!body_) return {};
  const std::size_t row = start_offset(axis) + at(y);
  const std::size_t first = body_->starts[row], last = body_->starts[row + 1];
  return {body_->packed[static_cast<int>(axis)].data() + first, last - first};
}

std::span<const Crossing> Chunk::crossings(Axis axis) const {
  if (!body_) return {};
  return body_->packed[static_cast<int>(axis)];
}

int Chunk::filled_voxels() const {
  if (!body_) return full_ ? resolution_ * resolution_ : 0;
  int count = 0;
  for (int y = 0; y < resolution_; ++y) count += std::popcount(row(y));
  return count;
}

int Chunk::crossing_count() const {
  return body_ ? static_cast<int>(body_->packed[0].size() + body_->packed[1].size()) : 0;
}

std::uint64_t Chunk::hash() const {
  const std::size_t rows_bytes = at(resolution_) * sizeof(std::uint64_t);
  std::vector<unsigned char> bytes(4 + rows_bytes +
                                   static_cast<std::size_t>(crossing_count()) * sizeof(Crossing));
  unsigned char* out = bytes.data();
  const auto append = [&out](const void* from, std::size_t size) {
    if (size > 0) std::memcpy(out, from, size);
    out += size;
  };
  const std::uint32_t resolution = resolution_;
  append(&resolution, 4);
  for (int y = 0; y < resolution_; ++y) {
    const std::uint64_t word = row(y);
    append(&word, sizeof word);
  }
  if (body_) {
    for (const auto& packed : body_->packed)
      append(packed.data(), packed.size() * sizeof(Crossing));
  }
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::size_t Chunk::body_bytes() const {
  if (!body_) return 0;
  return CopyOnWrite<Body>::kHeapBytes + body_->words.capacity() * 8 +
         body_->starts.capacity() * 2 +
         (body_->packed[0].capacity() + body_->packed[1].capacity()) * sizeof(Crossing);
}

}  // namespace earthwork::voxel
