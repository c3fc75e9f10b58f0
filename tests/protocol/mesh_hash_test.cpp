#include <gtest/gtest.h>

#include "protocol/chunk_record.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

TEST(TwiceArea, IsExact) {
  EXPECT_EQ(twice_area(ChunkMesh{}), 0u);
  EXPECT_EQ(twice_area(square_mesh()), 2ull * 32768 * 32768);
  ChunkMesh huge;
  huge.vertices = {{0, 0}, {2129919, 0}, {2129919, 2129919}, {0, 2129919}};
  huge.triangles = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(twice_area(huge), 2ull * 2129919 * 2129919);
}

TEST(TwiceArea, DoesNotDependOnTheTriangulation) {
  ChunkMesh other = square_mesh();
  other.triangles = {1, 2, 3, 3, 0, 1};
  EXPECT_EQ(twice_area(other), twice_area(square_mesh()));
  EXPECT_EQ(mesh_hash(other), mesh_hash(square_mesh()));
}

// The expected values are libxxhash's, over bytes put together by hand from the specification.
TEST(MeshHash, IsXxh3OverAreaAndSections) {
  EXPECT_EQ(hex(mesh_hash(ChunkMesh{})), "c77b3abb6f87acd9");
  EXPECT_EQ(hex(mesh_hash(square_mesh())), "2a9ee5232621d5b4");
  EXPECT_EQ(hex(mesh_hash_term({2, -1, 3, 0}, 0x0123456789abcdef)), "01be8aa7795c4c25");
}

TEST(MeshHash, SeesOrderEndsAndNormals) {
  const std::uint64_t hash = mesh_hash(square_mesh());
  ChunkMesh other = square_mesh();
  std::swap(other.sections[0], other.sections[1]);
  EXPECT_NE(mesh_hash(other), hash);
  other = square_mesh();
  other.sections[1].normal_b.y = 1;
  EXPECT_NE(mesh_hash(other), hash);
  other = square_mesh();
  std::swap(other.sections[3].a, other.sections[3].b);
  EXPECT_NE(mesh_hash(other), hash);
}

TEST(Hex, IsSixteenLowerCaseDigits) {
  EXPECT_EQ(hex(0), "0000000000000000");
  EXPECT_EQ(hex(0x0123456789abcdef), "0123456789abcdef");
  EXPECT_EQ(parse_hex("0123456789abcdef"), 0x0123456789abcdefu);
  EXPECT_EQ(parse_hex("ffffffffffffffff"), UINT64_MAX);
  for (const char* bad : {"", "0", "0123456789ABCDEF", "0123456789abcdefa", "0123456789abcdeg",
                          " 123456789abcdef", "0x23456789abcdef"})
    EXPECT_FALSE(parse_hex(bad)) << bad;
}

}  // namespace
}  // namespace earthwork::protocol
