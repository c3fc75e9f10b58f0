// Figures of maps small enough to count by hand.
#include "server/mesh/figures.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace earthwork::mesh {
namespace {

using voxel::Fill;
using voxel::Shape;
using voxel::Stencil;

constexpr Stencil kSquare{
    .x = 4, .y = 4, .radius = 1.25, .shape = Shape::square, .fill = Fill::filled};

Figures figures(voxel::Grid grid, std::initializer_list<Stencil> edits, int layer = 0) {
  voxel::Map map(grid);
  for (const Stencil& edit : edits) map.apply(layer, {&edit, 1});
  return count_figures(map, 135);
}

TEST(Figures, OfASquare) {
  const Figures f = figures({.resolution = 8, .bounds = voxel::ChunkRect{0, 0, 1, 1}}, {kSquare});
  EXPECT_DOUBLE_EQ(f.surface_area, 6.25);
  EXPECT_DOUBLE_EQ(f.wall_length, 10);
  EXPECT_EQ(f.filled_voxels, 4u);
  EXPECT_EQ(f.sharp_features, 4u);
  EXPECT_EQ(f.wall_sections, 12u);  // four sides of a cell, four corners of two
  EXPECT_EQ(f.cells_by_case[15], 1u);
  EXPECT_EQ(f.cells_by_case[0], 49u - 9u);
}

TEST(Figures, AreInMapUnits) {
  Stencil wide = kSquare;
  wide.x = wide.y = 12, wide.radius = 3.75;
  const Figures f =
      figures({.resolution = 8, .voxel_size = 3, .bounds = voxel::ChunkRect{0, 0, 1, 1}}, {wide});
  EXPECT_DOUBLE_EQ(f.surface_area, 56.25);
  EXPECT_DOUBLE_EQ(f.wall_length, 30);
}

TEST(Figures, OfAnUnboundedMapCountTheCellsOfItsChunks) {
  const Figures f = figures({.resolution = 8, .bounds = {}}, {kSquare});
  const auto all =
      std::accumulate(f.cells_by_case.begin(), f.cells_by_case.end(), std::uint64_t{0});
  EXPECT_EQ(all, 4u * 64u);  // the chunk, and those to the left and below that reach into it
}

TEST(Figures, AddUpLayers) {
  voxel::Map map({.resolution = 8, .layers = 2, .bounds = voxel::ChunkRect{0, 0, 1, 1}});
  map.apply(0, {&kSquare, 1});
  map.apply(1, {&kSquare, 1});
  const Figures f = count_figures(map, 135);
  EXPECT_DOUBLE_EQ(f.surface_area, 12.5);
  EXPECT_EQ(f.cells_by_case[0], 2u * 40u);
}

TEST(Figures, AFullMapEndsAtItsBorder) {
  const Stencil all{.x = 8, .y = 8, .radius = 20, .shape = Shape::square, .fill = Fill::filled};
  const Figures f = figures({.resolution = 8, .bounds = voxel::ChunkRect{0, 0, 2, 2}}, {all});
  EXPECT_DOUBLE_EQ(f.surface_area, 225);
  EXPECT_EQ(f.wall_sections, 0u);
  EXPECT_EQ(f.cells_by_case[15], 225u);
}

}  // namespace
}  // namespace earthwork::mesh
