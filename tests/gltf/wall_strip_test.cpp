#include "protocol/gltf/wall_strip.hpp"

#include <gtest/gtest.h>

#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

constexpr MeshNormal kUp{0, 32767}, kRight{32767, 0};

using Panels = std::vector<std::array<std::uint32_t, 2>>;

TEST(WallStrip, IsNothingWithoutSections) {
  EXPECT_TRUE(wall_strip(ChunkMesh{}).posts.empty());
  EXPECT_TRUE(wall_strip(ChunkMesh{}).panels.empty());
}

TEST(WallStrip, SharesPostsAroundASmoothContour) {
  ChunkMesh mesh;
  mesh.sections = {{0, 1, kUp, kRight}, {1, 2, kRight, kUp}, {2, 0, kUp, kUp}};
  const WallStrip strip = wall_strip(mesh);
  EXPECT_EQ(strip.posts, (std::vector<WallPost>{{0, kUp}, {1, kRight}, {2, kUp}}));
  EXPECT_EQ(strip.panels, (Panels{{0, 1}, {1, 2}, {2, 0}}));
}

TEST(WallStrip, StandsTwoPostsAtACrease) {
  const WallStrip strip = wall_strip(square_mesh());
  EXPECT_EQ(strip.posts.size(), 8u);
  EXPECT_EQ(strip.panels, (Panels{{0, 1}, {2, 3}, {4, 5}, {6, 7}}));
  EXPECT_EQ(strip.posts[1].vertex, strip.posts[2].vertex);
  EXPECT_NE(strip.posts[1].normal, strip.posts[2].normal);
}

TEST(WallStrip, ClosesEachContourAtItsOwnBeginning) {
  ChunkMesh mesh;
  mesh.sections = {{0, 1, kUp, kUp}, {1, 0, kUp, kUp}, {2, 3, kUp, kUp}, {3, 2, kUp, kUp}};
  const WallStrip strip = wall_strip(mesh);
  EXPECT_EQ(strip.posts.size(), 4u);
  EXPECT_EQ(strip.panels, (Panels{{0, 1}, {1, 0}, {2, 3}, {3, 2}}));
}

TEST(WallStrip, ClosesAContourWithACreaseAtItsBeginning) {
  ChunkMesh mesh;
  mesh.sections = {{0, 1, kUp, kUp}, {1, 0, kUp, kRight}};
  EXPECT_EQ(wall_strip(mesh).panels, (Panels{{0, 1}, {1, 2}}));
}

}  // namespace
}  // namespace earthwork::protocol
