#include "protocol/gltf/glb.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/gltf/glb_file.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

using Vector = std::array<double, 3>;

MapSettings two_layers() {
  MapSettings settings;
  settings.chunk_resolution = 8;
  settings.voxel_size = 0.5;
  settings.layers = {{"ground", "#ff8000", -1, 0.25}, {"water", "#0000ff", -3, -2}};
  return settings;
}

GlbFile file_of(const MapSettings& settings, const MeshMap& meshes) {
  const auto bytes = write_glb(settings, meshes);
  EXPECT_TRUE(bytes);
  return GlbFile(*bytes);
}

Vector minus(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return {double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Every triangle's front, by its winding, is on the side of its vertices' normals.
void expect_front_faces(const GlbPrimitive& primitive) {
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const auto* corner = &primitive.indices[i];
    const Vector face =
        cross(minus(primitive.positions[corner[1]], primitive.positions[corner[0]]),
              minus(primitive.positions[corner[2]], primitive.positions[corner[0]]));
    for (int k = 0; k < 3; ++k) {
      const auto& normal = primitive.normals[corner[k]];
      EXPECT_GT(face[0] * normal[0] + face[1] * normal[1] + face[2] * normal[2], 0);
      EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-6);
    }
  }
}

TEST(Glb, TurnsTheMapIntoGltfsAxes) {
  const ChunkMesh mesh = square_mesh();
  const GlbFile file = file_of(two_layers(), {{{0, -1, 3, 0}, &mesh}});
  // A chunk is 8 voxels of 0.5: its origin is (-4, 12) on the map.
  EXPECT_EQ(file.node("chunk_-1_3")["translation"], nlohmann::json({-4.0, 0.0, -12.0}));
  const auto primitives = file.primitives("chunk_-1_3");
  ASSERT_EQ(primitives.size(), 2u);
  const GlbPrimitive& surface = primitives[0];
  EXPECT_EQ(surface.material, "surface");
  // Voxel corners at 1.5 and 2.5 voxels are 0.75 and 1.25 units; the layer's top is 0.25.
  EXPECT_EQ(surface.positions, (std::vector<std::array<float, 3>>{{0.75f, 0.25f, -0.75f},
                                                                  {1.25f, 0.25f, -0.75f},
                                                                  {1.25f, 0.25f, -1.25f},
                                                                  {0.75f, 0.25f, -1.25f}}));
  EXPECT_EQ(surface.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  for (const auto& normal : surface.normals) EXPECT_EQ(normal, (std::array<float, 3>{0, 1, 0}));
  expect_front_faces(surface);
}

TEST(Glb, StandsWallsFromBottomToTopFacingOut) {
  const ChunkMesh mesh = square_mesh();
  const GlbFile file = file_of(two_layers(), {{{0, 0, 0, 0}, &mesh}});
  const GlbPrimitive wall = file.primitives("chunk_0_0").at(1);
  EXPECT_EQ(wall.material, "wall");
  EXPECT_EQ(wall.positions.size(), 16u) << "four creases: nothing is shared";
  EXPECT_EQ(wall.indices.size(), 24u);
  // The first section runs along the lower side: map -y is glTF's +Z.
  EXPECT_EQ(wall.positions[0], (std::array<float, 3>{0.75f, -1, -0.75f}));
  EXPECT_EQ(wall.positions[1], (std::array<float, 3>{0.75f, 0.25f, -0.75f}));
  EXPECT_EQ(wall.positions[2], (std::array<float, 3>{1.25f, -1, -0.75f}));
  EXPECT_EQ(wall.normals[0], (std::array<float, 3>{0, 0, 1}));
  expect_front_faces(wall);
  for (std::size_t i = 0; i < wall.positions.size(); ++i) {
    const double x = wall.positions[i][0] - 1, z = wall.positions[i][2] + 1;
    EXPECT_GT(x * wall.normals[i][0] + z * wall.normals[i][2], 0) << "away from the middle";
  }
}

TEST(Glb, IsExactToStoredPrecision) {
  ChunkMesh mesh = square_mesh();
  mesh.vertices[2] = {2'129'919, 2'129'917};
  MapSettings settings;
  settings.chunk_resolution = 64;
  const auto surface = file_of(settings, {{{0, 0, 0, 0}, &mesh}}).primitives("chunk_0_0").at(0);
  EXPECT_EQ(surface.positions[2][0] * 32768.0, 2'129'919);
  EXPECT_EQ(surface.positions[2][2] * 32768.0, -2'129'917);
}

TEST(Glb, BoundsPositionsExactly) {
  const ChunkMesh mesh = bend_mesh();
  const GlbFile file = file_of(two_layers(), {{{1, 0, 0, 0}, &mesh}});
  int bounded = 0;
  for (const auto& accessor : file.json()["accessors"]) {
    if (!accessor.contains("min")) continue;
    const auto primitive = file.primitives("chunk_0_0").at(static_cast<std::size_t>(bounded++));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::minmax_element(primitive.positions.begin(), primitive.positions.end(),
                              [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
      EXPECT_EQ(accessor["min"][axis].get<double>(), double{(*low)[axis]});
      EXPECT_EQ(accessor["max"][axis].get<double>(), double{(*high)[axis]});
    }
  }
  EXPECT_EQ(bounded, 2);
}

TEST(Glb, HasANodeForEachLayerAndChunk) {
  const ChunkMesh mesh = square_mesh(), empty;
  const GlbFile file =
      file_of(two_layers(), {{{0, 0, 0, 0}, &mesh}, {{0, 1, 0, 0}, &empty}, {{1, 0, 0, 0}, &mesh}});
  const auto& json = file.json();
  ASSERT_EQ(json["scenes"][0]["nodes"].size(), 2u);
  std::vector<std::string> names;
  for (const std::size_t layer : json["scenes"][0]["nodes"]) {
    names.push_back(json["nodes"][layer]["name"]);
    for (const std::size_t chunk : json["nodes"][layer]["children"])
      names.push_back(json["nodes"][chunk]["name"]);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"ground", "chunk_0_0", "water", "chunk_0_0"}));
  EXPECT_EQ(json["asset"]["generator"], "earthwork");
  ASSERT_EQ(json["materials"].size(), 4u);
  const auto color = json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_EQ(color, nlohmann::json({1.0, 0.215861, 0.0, 1.0})) << "linear, not sRGB";
}

TEST(Glb, IsAFileWithoutAnyMesh) {
  const GlbFile file = file_of(two_layers(), {});
  EXPECT_FALSE(file.json().contains("buffers"));
  EXPECT_FALSE(file.json().contains("meshes"));
  EXPECT_EQ(file.json()["scenes"][0]["nodes"].size(), 2u);
}

TEST(Glb, WidensTheIndicesOfALongWall) {
  ChunkMesh mesh;
  mesh.vertices.resize(16384);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = {static_cast<std::int32_t>(i), static_cast<std::int32_t>(i % 2)};
  const auto add = [&mesh](std::uint16_t a) {
    mesh.sections.push_back({a, static_cast<std::uint16_t>(a + 1), {0, 32767}, {32767, 0}});
  };
  for (std::uint16_t a = 0; a < 16383; ++a) add(a);
  const auto narrow = file_of(two_layers(), {{{0, 0, 0, 0}, &mesh}}).primitives("chunk_0_0").at(0);
  EXPECT_EQ(narrow.positions.size(), 65532u);
  EXPECT_EQ(narrow.index_type, 5123);
  add(5);
  const auto wide = file_of(two_layers(), {{{0, 0, 0, 0}, &mesh}}).primitives("chunk_0_0").at(0);
  EXPECT_EQ(wide.positions.size(), 65536u);
  EXPECT_EQ(wide.index_type, 5125);
  EXPECT_EQ(wide.indices.back(), 65533u);
}

TEST(Glb, GivesTheSameBytesAgain) {
  const ChunkMesh square = square_mesh(), bend = bend_mesh();
  const MeshMap meshes{{{0, 0, 0, 0}, &square}, {{1, -2, 0, 0}, &bend}};
  EXPECT_EQ(*write_glb(two_layers(), meshes), *write_glb(two_layers(), meshes));
}

TEST(Glb, RefusesMoreThanFourGibibytesBeforeItTakesThem) {
  ChunkMesh large;
  large.vertices.resize(65535);
  large.triangles.assign(3'000'000, 0);
  MeshMap meshes;
  for (int x = 0; x < 570; ++x) meshes[{0, x, 0, 0}] = &large;
  const auto refused = write_glb(two_layers(), meshes);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_large);
  EXPECT_EQ(refused.error().detail, "the map's meshes are beyond the 4 GiB of a GLB file");
}

}  // namespace
}  // namespace earthwork::protocol
