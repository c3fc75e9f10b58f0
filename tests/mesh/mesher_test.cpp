// Meshes of random maps: whole, without T-junctions, walled exactly where the ground ends, and the
// same whichever way the map came about.
#include "server/mesh/mesher.hpp"

#include <gtest/gtest.h>

#include "server/mesh/figures.hpp"
#include "tests/mesh/mesh_checks.hpp"
#include "tests/voxel/random_edits.hpp"

namespace earthwork::mesh {
namespace {

using voxel::Fill;
using voxel::Grid;
using voxel::Shape;
using voxel::Stencil;

Stencil square(double x, double y, double radius, Fill fill = Fill::filled) {
  return {.x = x, .y = y, .radius = radius, .shape = Shape::square, .fill = fill};
}

voxel::Map played(const Grid& grid, const std::vector<Stencil>& edits) {
  voxel::Map map(grid);
  for (const Stencil& edit : edits) map.apply(0, {&edit, 1});
  return map;
}

std::size_t triangles(const Meshes& meshes) {
  std::size_t count = 0;
  for (const auto& [key, mesh] : meshes) count += mesh.triangles.size() / 3;
  return count;
}

RC_GTEST_PROP(Mesher, GivesSoundTriangles, ()) {
  const voxel::Map map = played(*voxel::any_grid(), *voxel::any_edits(12));
  for (const auto& [key, mesh] : mesh_all(map)) RC_ASSERT(flaw(mesh) == "");
}

// The whole map's triangle edges cancel except at walls and the border: so nothing overlaps at an
// edge, no vertex lies on another's edge, and neighbours agree on their rim.
RC_GTEST_PROP(Mesher, TheOutlineIsTheWallsAndTheBorder, ()) {
  const Grid grid = *voxel::any_grid();
  const voxel::Map map = played(grid, *voxel::any_edits(12));
  const Meshes meshes = mesh_all(map);
  auto open = outline(meshes, grid.resolution);
  drop_border(open, grid);
  RC_ASSERT(open == wall_edges(meshes, grid.resolution));
}

RC_GTEST_PROP(Mesher, TheAreaIsThatOfTheCells, ()) {
  const voxel::Map map = played(*voxel::any_grid(), *voxel::any_edits(12));
  std::uint64_t twice = 0;
  for (const auto& [key, mesh] : mesh_all(map)) twice += twice_area(mesh);
  RC_ASSERT(static_cast<double>(twice) / 2 / 32768 / 32768 == count_figures(map, 135).surface_area);
}

RC_GTEST_PROP(Mesher, IncrementalIsFull, ()) {
  const Grid grid = *voxel::any_grid();
  const double angle = *rc::gen::element(30.0, 90.0, 135.0, 175.0);
  voxel::Map map(grid);
  Mesher mesher(angle);
  Meshes kept;
  for (const Stencil& edit : *voxel::any_edits(12)) {
    for (const voxel::DirtyChunk& dirty : map.apply(0, {&edit, 1}).dirty) {
      ChunkMesh mesh;
      mesher.mesh(map.neighbourhood(dirty.key), grid.resolution, mesh);
      if (mesh.empty()) {
        kept.erase(dirty.key);
      } else {
        kept[dirty.key] = mesh;
      }
    }
  }
  RC_ASSERT(kept == mesh_all(map, angle));
}

// The same ground painted in another order of places that do not meet: the same meshes.
RC_GTEST_PROP(Mesher, HistoryDoesNotShow, ()) {
  const auto near = *voxel::any_edits(10);
  auto far = *voxel::any_edits(10);
  for (Stencil& edit : far) edit.x += 200;
  std::vector<Stencil> one = near, other = far;
  one.insert(one.end(), far.begin(), far.end());
  other.insert(other.end(), near.begin(), near.end());
  const Grid grid{.resolution = *voxel::any_resolution(), .bounds = {}};
  RC_ASSERT(mesh_all(played(grid, one)) == mesh_all(played(grid, other)));
}

RC_GTEST_PROP(Mesher, CellsOutsideTheDirtyOnesKeepTheirContour, ()) {
  const Grid grid = *voxel::any_grid();
  voxel::Map map = played(grid, *voxel::any_edits(8));
  const auto sections_by_place = [&](const Meshes& meshes, const voxel::Change& change) {
    std::multiset<DirectedEdge> kept;
    for (const auto& [key, mesh] : meshes) {
      const auto dirty = std::find_if(change.dirty.begin(), change.dirty.end(),
                                      [&](const auto& d) { return d.key == key; });
      if (dirty != change.dirty.end()) continue;
      for (const Section& s : mesh.sections) {
        kept.insert({at(key, grid.resolution, mesh.vertices[s.a]),
                     at(key, grid.resolution, mesh.vertices[s.b])});
      }
    }
    return kept;
  };
  const Meshes before = mesh_all(map);
  const Stencil edit = *voxel::any_stencil(12);
  const voxel::Change change = map.apply(0, {&edit, 1});
  RC_ASSERT(sections_by_place(before, change) == sections_by_place(mesh_all(map), change));
}

TEST(Mesher, AFullChunkIsTwoTriangles) {
  const voxel::Map map = played({.bounds = voxel::ChunkRect{0, 0, 2, 2}}, {square(32, 32, 40)});
  const Meshes meshes = mesh_all(map);
  EXPECT_EQ(meshes.size(), 4u);
  EXPECT_EQ(triangles(meshes), 8u);
  const ChunkMesh& inner = meshes.at({0, 0, 0, 0});
  EXPECT_EQ(inner.vertices.front(), (Point{16384, 16384}));
  EXPECT_EQ(inner.vertices.back(), (Point{16384 + 32 * 32768, 16384 + 32 * 32768}));
  const ChunkMesh& last = meshes.at({0, 1, 1, 0});  // the border cuts the gap cells off
  EXPECT_EQ(last.vertices.back(), (Point{16384 + 31 * 32768, 16384 + 31 * 32768}));
}

TEST(Mesher, ASquareInOneChunkIsTwoTrianglesAndFourWalls) {
  const voxel::Map map = played({.bounds = {}}, {square(10, 12, 5.25)});
  const Meshes meshes = mesh_all(map);
  ASSERT_EQ(meshes.size(), 1u);
  const ChunkMesh& mesh = meshes.begin()->second;
  EXPECT_EQ(mesh.triangles.size(), 6u);
  EXPECT_EQ(mesh.sections.size(), 4u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[0], (Point{155648, 221184}));  // 4.75 and 6.75 voxels
  EXPECT_EQ(twice_area(mesh), 2ull * 344064 * 344064);   // 10.5 voxels squared
}

TEST(Mesher, ACreaseStandsTwice) {
  const voxel::Map map = played({.bounds = {}}, {square(10, 12, 5.25)});
  const Meshes meshes = mesh_all(map);
  const ChunkMesh& mesh = meshes.begin()->second;
  for (const Section& s : mesh.sections) EXPECT_EQ(s.normal_a, s.normal_b);
  EXPECT_NE(mesh.sections[0].normal_b, mesh.sections[1].normal_a);
}

TEST(Mesher, WallsAreSmoothWhereTheyMeet) {
  const Stencil disc{.x = 16, .y = 16, .radius = 8, .shape = Shape::circle, .fill = Fill::filled};
  const Meshes meshes = mesh_all(played({.bounds = {}}, {disc}));
  const ChunkMesh& mesh = meshes.begin()->second;
  ASSERT_GT(mesh.sections.size(), 40u);
  for (std::size_t k = 1; k < mesh.sections.size(); ++k) {
    EXPECT_EQ(mesh.sections[k - 1].b, mesh.sections[k].a);
    EXPECT_EQ(mesh.sections[k - 1].normal_b, mesh.sections[k].normal_a);
  }
}

TEST(Mesher, AChunkThatHoldsNothingHasTheTipOfItsNeighboursVoxel) {
  const voxel::Map map = played({.resolution = 8, .bounds = {}}, {square(8.5, 8.5, 0.25)});
  ASSERT_EQ(map.find({0, 0, 0, 0}), nullptr);
  const Meshes meshes = mesh_all(map);
  ASSERT_TRUE(meshes.contains({0, 0, 0, 0}));
  // A corner's quarter of the voxel's square, cut by the rim into two triangles.
  EXPECT_EQ(twice_area(meshes.at({0, 0, 0, 0})), 2u * 8192 * 8192);
}

TEST(Mesher, AHoleCostsTwoTrianglesMoreThanItsVertices) {
  const voxel::Map map =
      played({.bounds = {}}, {square(16, 16, 10), square(16, 16, 4, Fill::empty)});
  EXPECT_EQ(triangles(mesh_all(map)), 8u);  // 8 vertices, one hole
}

TEST(Mesher, TheWorstChunkKeepsWithinItsIndices) {
  voxel::Map map(Grid{.resolution = 64, .bounds = voxel::ChunkRect{0, 0, 2, 2}});
  std::vector<Stencil> dots;
  for (int k = 0; k < 128 * 128; ++k) {
    if ((k % 128 + k / 128) % 2 == 0) dots.push_back(square(k % 128 + 0.5, k / 128 + 0.5, 0.5));
  }
  map.apply(0, dots);
  const Meshes meshes = mesh_all(map);
  const ChunkMesh& mesh = meshes.at({0, 0, 0, 0});
  EXPECT_GT(mesh.vertices.size(), 8000u);
  EXPECT_LT(mesh.vertices.size(), 0xFFFFu);
  EXPECT_EQ(flaw(mesh), "");
}

}  // namespace
}  // namespace earthwork::mesh
