// Wall normals, worked out by hand.
#include "server/mesh/walls.hpp"

#include <gtest/gtest.h>

namespace earthwork::mesh {
namespace {

constexpr Point kOrigin{0, 0}, kRight{1000, 0}, kUp{0, 1000};

TEST(RepairedNormal, IsKeptWhenItFacesOut) {
  const voxel::Normal slanted{20000, -25955};
  EXPECT_EQ(repaired(slanted, kOrigin, kRight), slanted);
}

TEST(RepairedNormal, IsTheSectionsWhenItFacesIn) {
  EXPECT_EQ(repaired({0, 32767}, kOrigin, kRight), (voxel::Normal{0, -32767}));
  EXPECT_EQ(repaired({-20000, 25955}, kOrigin, kUp), (voxel::Normal{32767, 0}));
}

TEST(RepairedNormal, IsTheSectionsWhenItLiesAlongIt) {
  EXPECT_EQ(repaired({32767, 0}, kOrigin, kRight), (voxel::Normal{0, -32767}));
}

TEST(RepairedNormal, IsRoundedHalvesAwayFromZero) {
  EXPECT_EQ(repaired({0, 0}, kOrigin, {4000, 3000}), (voxel::Normal{19660, -26214}));
  EXPECT_EQ(repaired({0, 0}, kOrigin, {-4000, -3000}), (voxel::Normal{-19660, 26214}));
}

}  // namespace
}  // namespace earthwork::mesh
