#include "client/viewer/render/batch_mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>

namespace earthwork::viewer::render {
namespace {

using protocol::ChunkKey;
using protocol::ChunkMesh;
using scene::Scene;

constexpr std::int32_t kVoxel = 32768;

/// A triangle of two voxels a side, its lower left corner at `x`, `y` voxels, and no walls.
ChunkMesh triangle(std::int32_t x, std::int32_t y) {
  ChunkMesh mesh;
  mesh.vertices = {
      {x * kVoxel, y * kVoxel}, {(x + 2) * kVoxel, y * kVoxel}, {x * kVoxel, (y + 2) * kVoxel}};
  mesh.triangles = {0, 1, 2};
  return mesh;
}

void put(Scene::Chunks& chunks, const ChunkKey& key, ChunkMesh mesh) {
  chunks[key].mesh = std::move(mesh);
}

BatchMesh rebuilt(const Scene::Chunks& chunks, const BatchKey& key, int resolution = 32) {
  BatchMesh mesh;
  mesh.rebuild(chunks, key, resolution);
  return mesh;
}

TEST(BatchOf, IsOf256VoxelsASide) {
  EXPECT_EQ(batch_of({1, 7, 8, 0}, 32), (BatchKey{1, 0, 1}));
  EXPECT_EQ(batch_of({0, 3, 4, 0}, 64), (BatchKey{0, 0, 1}));
  EXPECT_EQ(batch_of({0, 31, 32, 0}, 8), (BatchKey{0, 0, 1}));
}

TEST(BatchOf, CountsDownwardToTheLeftOfTheOrigin) {
  EXPECT_EQ(batch_of({0, -1, -8, 0}, 32), (BatchKey{0, -1, -1}));
  EXPECT_EQ(batch_of({0, -9, -16, 0}, 32), (BatchKey{0, -2, -2}));
}

TEST(BatchMesh, HoldsItsOwnChunksOnly) {
  Scene::Chunks chunks;
  put(chunks, {0, 0, 0, 0}, triangle(1, 1));
  put(chunks, {0, 7, 7, 0}, triangle(2, 3));
  for (const ChunkKey& other :
       {ChunkKey{0, 8, 0, 0}, {0, 0, 8, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}, {1, 0, 0, 0}})
    put(chunks, other, triangle(0, 0));
  const BatchMesh mesh = rebuilt(chunks, {0, 0, 0});
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(mesh.vertices[0], (BatchVertex{1, 1, {}, 1, 0}));
  EXPECT_EQ(mesh.vertices[3], (BatchVertex{7 * 32 + 2, 7 * 32 + 3, {}, 1, 0}));
}

TEST(BatchMesh, CountsFromTheLowerLeftCornerOfNegativeBatches) {
  Scene::Chunks chunks;
  put(chunks, {0, -1, -8, 0}, triangle(0, 1));
  const BatchMesh mesh = rebuilt(chunks, {0, -1, -1});
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], (BatchVertex{7 * 32, 1, {}, 1, 0}));
}

TEST(BatchMesh, LosesNothingOfAPosition) {
  Scene::Chunks chunks;
  ChunkMesh mesh = triangle(0, 0);
  mesh.vertices[0] = {65 * kVoxel - 1, 64 * kVoxel + 1};
  put(chunks, {0, 3, 3, 0}, mesh);  // the far corner of a batch
  const BatchMesh batch = rebuilt(chunks, {0, 0, 0}, 64);
  EXPECT_EQ(double{batch.vertices[0].x} * kVoxel, (3 * 64 + 65) * double{kVoxel} - 1);
  EXPECT_EQ(double{batch.vertices[0].y} * kVoxel, (3 * 64 + 64) * double{kVoxel} + 1);
}

TEST(BatchMesh, IsEmptyWhereNothingIs) {
  const BatchMesh mesh = rebuilt({}, {0, 0, 0});
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.indices.empty());
}

TEST(BatchMesh, ForgetsWhatItHeldBefore) {
  Scene::Chunks chunks;
  put(chunks, {0, 0, 0, 0}, triangle(1, 1));
  BatchMesh mesh = rebuilt(chunks, {0, 0, 0});
  mesh.rebuild({}, {0, 0, 0}, 32);
  EXPECT_TRUE(mesh.indices.empty());
}

/// A surface's three sides as walls, the normals at a corner alike or not.
ChunkMesh with_walls(bool smooth) {
  ChunkMesh mesh = triangle(0, 0);
  const protocol::MeshNormal down{0, -32767}, out{23170, 23170}, left{-32767, 0};
  mesh.sections = {{0, 1, down, smooth ? out : down}, {1, 2, out, out}, {2, 0, left, left}};
  return mesh;
}

std::size_t wall_vertices(const BatchMesh& mesh) {
  std::size_t count = 0;
  for (const BatchVertex& vertex : mesh.vertices) count += vertex.wall == 1 ? 1 : 0;
  return count;
}

TEST(BatchMesh, SharesAPostWhereASmoothWallGoesOn) {
  Scene::Chunks chunks;
  put(chunks, {0, 0, 0, 0}, with_walls(true));
  EXPECT_EQ(wall_vertices(rebuilt(chunks, {0, 0, 0})), 10u);  // 5 posts
  put(chunks, {0, 0, 0, 0}, with_walls(false));
  EXPECT_EQ(wall_vertices(rebuilt(chunks, {0, 0, 0})), 12u);  // 6 posts
}

TEST(BatchMesh, WallsStandFromBottomToTopAndFaceOutward) {
  Scene::Chunks chunks;
  put(chunks, {0, 0, 0, 0}, with_walls(false));
  const BatchMesh mesh = rebuilt(chunks, {0, 0, 0});
  ASSERT_EQ(mesh.indices.size(), 3u + 3 * 6);
  for (std::size_t i = 3; i < mesh.indices.size(); i += 3) {
    const BatchVertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                      &c = mesh.vertices[mesh.indices[i + 2]];
    EXPECT_EQ(a.wall + b.wall + c.wall, 3);
    EXPECT_TRUE(a.top + b.top + c.top == 1 || a.top + b.top + c.top == 2);
    // Across b - a and c - a, with the heights as z: the triangle's own normal.
    const std::array<float, 3> u = {b.x - a.x, b.y - a.y, static_cast<float>(b.top - a.top)};
    const std::array<float, 3> v = {c.x - a.x, c.y - a.y, static_cast<float>(c.top - a.top)};
    const float nx = u[1] * v[2] - u[2] * v[1], ny = u[2] * v[0] - u[0] * v[2];
    EXPECT_GT(nx * a.normal.x + ny * a.normal.y, 0) << "triangle " << i / 3;
  }
}

}  // namespace
}  // namespace earthwork::viewer::render
