#include "server/journal/chunk_place.hpp"

#include <cassert>

namespace earthwork::journal {
namespace {

constexpr std::int32_t kBias = 1 << 20;
constexpr std::uint64_t kThirds = 0x1249249249249249;  // bits 0, 3 .. 60

// Each step halves the runs of bits that stand together, and moves the upper half away.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001F00000000FFFF;
  bits = (bits | bits << 16) & 0x001F0000FF0000FF;
  bits = (bits | bits << 8) & 0x100F00F00F00F00F;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3;
  return (bits | bits << 2) & kThirds;
}

std::uint64_t gather(std::uint64_t bits) {
  bits &= kThirds;
  bits = (bits | bits >> 2) & 0x10C30C30C30C30C3;
  bits = (bits | bits >> 4) & 0x100F00F00F00F00F;
  bits = (bits | bits >> 8) & 0x001F0000FF0000FF;
  bits = (bits | bits >> 16) & 0x001F00000000FFFF;
  return (bits | bits >> 32) & 0x1FFFFF;
}

std::uint64_t biased(std::int32_t coordinate) {
  assert(coordinate >= -kBias && coordinate < kBias);
  return static_cast<std::uint64_t>(coordinate + kBias);
}

std::int32_t unbiased(std::uint64_t bits) { return static_cast<std::int32_t>(bits) - kBias; }

}  // namespace

std::int64_t place_of(const voxel::ChunkKey& key) {
  return static_cast<std::int64_t>(spread(biased(key.x)) | spread(biased(key.y)) << 1 |
                                   spread(biased(key.z)) << 2);
}

std::optional<voxel::ChunkKey> key_of(std::int32_t layer, std::int64_t place) {
  if (place < 0) return std::nullopt;
  const auto bits = static_cast<std::uint64_t>(place);
  return voxel::ChunkKey{.layer = layer,
                         .x = unbiased(gather(bits)),
                         .y = unbiased(gather(bits >> 1)),
                         .z = unbiased(gather(bits >> 2))};
}

}  // namespace earthwork::journal
