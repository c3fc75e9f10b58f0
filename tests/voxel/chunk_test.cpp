// A chunk's packing and its canonical bytes.
#include "server/voxel/chunk.hpp"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <string>

namespace earthwork::voxel {
namespace {

/// Voxel (1, 0) of a chunk of 8 filled, with its three edges inside the chunk.
ChunkParts one_voxel() {
  ChunkParts parts;
  parts.resolution = 8;
  parts.rows[0] = 0b10;
  parts.x_masks[0] = 0b11, parts.y_masks[0] = 0b10;
  parts.x = {{0x1111, {-32767, 0}}, {0x2222, {32767, 0}}};
  parts.y = {{0x3333, {0, 32767}}};
  return parts;
}

TEST(Chunk, WithoutCrossingsHasNoBody) {
  const Chunk empty(32);
  EXPECT_TRUE(empty.uniform());
  EXPECT_TRUE(empty.blank());
  EXPECT_EQ(empty.body_bytes(), 0u);
  ChunkParts parts;
  parts.resolution = 32;
  for (int y = 0; y < 32; ++y) parts.rows[static_cast<std::size_t>(y)] = 0xFFFFFFFF;
  const Chunk full = Chunk::assemble(parts);
  EXPECT_TRUE(full.uniform());
  EXPECT_FALSE(full.blank());
  EXPECT_EQ(full.row(31), 0xFFFFFFFFu);
  EXPECT_EQ(full.filled_voxels(), 1024);
  EXPECT_EQ(full.body_bytes(), 0u);
}

TEST(Chunk, FindsTheCrossingsOfARow) {
  const Chunk chunk = Chunk::assemble(one_voxel());
  EXPECT_TRUE(chunk.filled(1, 0));
  EXPECT_FALSE(chunk.filled(0, 0));
  ASSERT_EQ(chunk.crossings(Axis::x, 0).size(), 2u);
  EXPECT_EQ(chunk.crossings(Axis::x, 0)[1].offset, 0x2222);
  EXPECT_TRUE(chunk.crossings(Axis::x, 1).empty());
  ASSERT_EQ(chunk.crossings(Axis::y, 0).size(), 1u);
  EXPECT_EQ(chunk.crossings(Axis::y, 0)[0].offset, 0x3333);
  EXPECT_EQ(chunk.crossing_count(), 3);
}

TEST(Chunk, HashesItsCanonicalBytes) {
  std::string bytes("\x08\0\0\0", 4);
  bytes += std::string("\x02\0\0\0\0\0\0\0", 8) + std::string(7 * 8, '\0');
  bytes += std::string("\x11\x11\x01\x80\0\0", 6) + std::string("\x22\x22\xFF\x7F\0\0", 6);
  bytes += std::string("\x33\x33\0\0\xFF\x7F", 6);
  EXPECT_EQ(Chunk::assemble(one_voxel()).hash(), XXH3_64bits(bytes.data(), bytes.size()));
}

TEST(Chunk, HashesAUniformOneLikeAnyOther) {
  const std::string bytes = std::string("\x40\0\0\0", 4) + std::string(64 * 8, '\xFF');
  ChunkParts parts;
  parts.resolution = 64;
  parts.rows.fill(~std::uint64_t{0});
  EXPECT_EQ(Chunk::assemble(parts).hash(), XXH3_64bits(bytes.data(), bytes.size()));
}

TEST(Chunk, HashesEveryField) {
  const std::uint64_t hash = Chunk::assemble(one_voxel()).hash();
  ChunkParts other = one_voxel();
  other.x[0].normal.y = 1;
  EXPECT_NE(Chunk::assemble(other).hash(), hash);
  other = one_voxel();
  other.y[0].offset ^= 1;
  EXPECT_NE(Chunk::assemble(other).hash(), hash);
}

}  // namespace
}  // namespace earthwork::voxel
