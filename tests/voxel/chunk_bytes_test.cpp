// A chunk's bytes: one form, from which the same chunk comes back, and nothing from any other.
#include "server/voxel/chunk_bytes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <string_view>

#include "server/voxel/map.hpp"
#include "tests/voxel/random_edits.hpp"

namespace earthwork::voxel {
namespace {

using namespace std::string_literals;

std::string encoded(const Chunk& chunk) {
  std::string bytes;
  encode_chunk(chunk, bytes);
  return bytes;
}

std::optional<Chunk> decoded(std::string_view bytes) {
  return decode_chunk(std::as_bytes(std::span(bytes)));
}

void expect_same(const Chunk& a, const Chunk& b) {
  RC_ASSERT(a.resolution() == b.resolution());
  RC_ASSERT(a.uniform() == b.uniform());
  RC_ASSERT(a.hash() == b.hash());
  for (int y = 0; y < a.resolution(); ++y) {
    RC_ASSERT(a.row(y) == b.row(y));
    for (const Axis axis : {Axis::x, Axis::y}) {
      RC_ASSERT(a.mask(axis, y) == b.mask(axis, y));
      RC_ASSERT(a.crossing_count(axis, y) == b.crossing_count(axis, y));
    }
  }
}

Chunk uniform(int resolution, bool full) {
  ChunkParts parts;
  parts.resolution = resolution;
  if (full) parts.rows[0] = 1;
  return Chunk::assemble(parts);
}

/// Voxel (0, 0) of a chunk of 8 filled.
std::string corner_bytes() {
  return "\x30\x01\0\0\0\0\0\0\0\0\0"s + "\x22\x11\xFF\x7F\0\0"s + "\x44\x33\0\0\xFF\x7F"s;
}

TEST(ChunkBytes, OfAUniformChunkAreOne) {
  EXPECT_EQ(encoded(uniform(8, false)), "\x10");
  EXPECT_EQ(encoded(uniform(64, true)), "\x23");
  ASSERT_TRUE(decoded("\x10"));
  EXPECT_TRUE(decoded("\x10")->blank());
  ASSERT_TRUE(decoded("\x23"));
  EXPECT_EQ(decoded("\x23")->filled_voxels(), 64 * 64);
}

TEST(ChunkBytes, AreRowsAndThenCrossings) {
  const auto chunk = decoded(corner_bytes());
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->resolution(), 8);
  EXPECT_EQ(chunk->filled_voxels(), 1);
  ASSERT_EQ(chunk->crossing_count(), 2);
  EXPECT_EQ(chunk->crossings(Axis::x, 0)[0], (Crossing{0x1122, {32767, 0}}));
  EXPECT_EQ(chunk->crossings(Axis::y, 0)[0], (Crossing{0x3344, {0, 32767}}));
  EXPECT_EQ(encoded(*chunk), corner_bytes());
}

TEST(ChunkBytes, TellWhichEdgesTowardNeighboursHaveCrossings) {
  ChunkParts parts;
  parts.resolution = 8;
  parts.rows.fill(0), parts.x_masks[3] = 0x80, parts.y_masks[7] = 0x04;
  parts.x = {{5, {-32767, 0}}}, parts.y = {{6, {0, -32767}}};
  const std::string bytes = encoded(Chunk::assemble(parts));
  EXPECT_EQ(bytes.substr(9, 2), "\x08\x04");
  const auto chunk = decoded(bytes);
  ASSERT_TRUE(chunk);
  EXPECT_EQ(chunk->mask(Axis::x, 3), 0x80u);
  EXPECT_EQ(chunk->mask(Axis::y, 7), 0x04u);
}

TEST(ChunkBytes, AreAtMostTheirLimit) {
  ChunkParts parts;
  parts.resolution = 64;
  for (std::size_t y = 0; y < 64; ++y)
    parts.rows[y] = y % 2 == 0 ? 0x5555555555555555u : ~0x5555555555555555u;
  parts.x_masks.fill(~std::uint64_t{0}), parts.y_masks.fill(~std::uint64_t{0});
  parts.x.assign(64 * 64, {1, {0, 1}}), parts.y.assign(64 * 64, {32767, {0, 1}});
  const std::string bytes = encoded(Chunk::assemble(parts));
  EXPECT_EQ(bytes.size(), kMaxChunkBytes);
  ASSERT_TRUE(decoded(bytes));
  EXPECT_EQ(decoded(bytes)->crossing_count(), 8192);
}

TEST(ChunkBytes, AreRefusedWhenTheirSizeIsNotExact) {
  const std::string bytes = corner_bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decoded(std::string_view(bytes).substr(0, size))) << size;
  EXPECT_FALSE(decoded(bytes + '\0'));
  EXPECT_FALSE(decoded("\x10\0"s));
}

TEST(ChunkBytes, AreRefusedWhenTheyAreNotTheOneForm) {
  EXPECT_FALSE(decoded("\x14")) << "no such resolution";
  EXPECT_FALSE(decoded("\0"s)) << "no such kind";
  EXPECT_FALSE(decoded("\x40")) << "no such kind";
  EXPECT_FALSE(decoded("\x30" + std::string(10, '\0'))) << "blank, and not said so";
  EXPECT_FALSE(decoded("\x30" + std::string(8, '\xFF') + "\0\0"s)) << "full, and not said so";
}

TEST(ChunkBytes, AreRefusedWhenACrossingIsOnAVoxelOrBeyondItsRange) {
  const auto with = [](std::size_t at, std::string_view two) {
    std::string bytes = corner_bytes();
    bytes.replace(at, 2, two);
    return decoded(bytes).has_value();
  };
  EXPECT_TRUE(with(11, "\x01\0"s));
  EXPECT_FALSE(with(11, "\0\0"s));
  EXPECT_TRUE(with(17, "\xFF\x7F"s));
  EXPECT_FALSE(with(17, "\0\x80"s));
  EXPECT_TRUE(with(19, "\x01\x80"s));
  EXPECT_FALSE(with(19, "\0\x80"s));
  EXPECT_FALSE(with(21, "\0\x80"s));
}

RC_GTEST_PROP(ChunkBytes, GiveTheSameChunkBack, ()) {
  const Grid grid = *any_grid();
  const auto edits = *any_edits(40);
  Map map(grid);
  map.apply(0, edits);
  for (const ChunkKey& key : map.keys()) {
    const Chunk& chunk = *map.find(key);
    const auto again = decoded(encoded(chunk));
    RC_ASSERT(again.has_value());
    expect_same(*again, chunk);
  }
}

RC_GTEST_PROP(ChunkBytes, ThatAreReadAreThoseThatAreWritten, ()) {
  std::string bytes = corner_bytes();
  const auto changes = *rc::gen::container<std::vector<std::pair<std::uint8_t, std::uint8_t>>>(
      rc::gen::pair(rc::gen::inRange<std::uint8_t>(0, 23), rc::gen::arbitrary<std::uint8_t>()));
  for (const auto& [at, to] : changes) bytes[at] = static_cast<char>(to);
  bytes.resize(*rc::gen::element<std::size_t>(23, 23, 29, 35, 41, 47), '\x01');
  const auto chunk = decoded(bytes);
  if (!chunk) return;
  RC_ASSERT(encoded(*chunk) == bytes);
}

}  // namespace
}  // namespace earthwork::voxel
