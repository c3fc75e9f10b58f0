#include "tests/protocol/samples.hpp"

#include <utility>

namespace earthwork::protocol {

ChunkMesh square_mesh() {
  constexpr std::int32_t low = 49152, high = 81920;  // voxel 1's centre, and voxel 2's
  constexpr MeshNormal down{0, -32767}, right{32767, 0}, up{0, 32767}, left{-32767, 0};
  return {
      .vertices = {{low, low}, {high, low}, {high, high}, {low, high}},
      .triangles = {0, 1, 2, 0, 2, 3},
      .sections = {{0, 1, down, down}, {1, 2, right, right}, {2, 3, up, up}, {3, 0, left, left}}};
}

ChunkMesh ordered_square_mesh() {
  ChunkMesh mesh = square_mesh();
  std::swap(mesh.vertices[2], mesh.vertices[3]);
  mesh.triangles = {0, 1, 2, 2, 1, 3};
  for (WallSection& section : mesh.sections)
    for (std::uint16_t* end : {&section.a, &section.b})
      if (*end >= 2) *end = static_cast<std::uint16_t>(5 - *end);
  return mesh;
}

ChunkMesh cut_square_mesh() {
  constexpr MeshNormal down{0, -32767}, right{32767, 0}, up{0, 32767}, left{-32767, 0};
  return {
      .vertices = {{49152, 49152}, {81920, 49152}, {81920, 80000}, {49152, 81920}, {80000, 81920}},
      .triangles = {0, 1, 2, 0, 2, 3, 3, 2, 4},
      .sections = {{0, 1, down, down},
                   {1, 2, right, right},
                   {2, 4, right, up},
                   {4, 3, up, up},
                   {3, 0, left, left}}};
}

ChunkMesh bend_mesh() {
  constexpr MeshNormal up{0, 32767}, slant{23170, 23170}, right{32767, 0}, down{0, -32767};
  return {.vertices = {{16384, 16384},
                       {16384, 60000},
                       {40000, 60000},
                       {50000, 50000},
                       {50000, 16384},
                       {100000, 20000},
                       {140000, 20000}},
          .triangles = {0, 2, 1, 0, 3, 2, 0, 4, 3},
          .sections = {{4, 3, right, right},
                       {3, 2, right, slant},  // a smooth end
                       {2, 1, up, up},        // a crease at its start
                       {6, 5, up, slant},     // a chain of its own
                       {5, 6, down, down}}};
}

ChunkMesh band_mesh(int columns) {
  ChunkMesh mesh;
  for (int i = 0; i <= columns; ++i) {
    mesh.vertices.push_back({16384 + i * 1000, 16384});
    mesh.vertices.push_back({16384 + i * 1000, 32768 + i % 7});
  }
  for (int i = 0; i < columns; ++i) {
    const auto a = static_cast<std::uint16_t>(2 * i);
    const auto at = [a](int step) { return static_cast<std::uint16_t>(a + step); };
    mesh.triangles.insert(mesh.triangles.end(), {a, at(2), at(3), a, at(3), at(1)});
    mesh.sections.push_back({a, at(2), {0, -32767}, {0, -32767}});
  }
  return mesh;
}

ChunkRecord record_of(ChunkMesh mesh) {
  return {.key = {.layer = 2, .x = -1, .y = 3, .z = 0},
          .revision = 258,
          .removed = false,
          .mesh = std::move(mesh)};
}

ChunkRecord removed_record() {
  return {.key = {.layer = 0, .x = 5, .y = -6, .z = 0}, .revision = 7, .removed = true, .mesh = {}};
}

std::string encoded(const ChunkRecord& record) {
  std::string bytes;
  encode_record(record, bytes);
  return bytes;
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace earthwork::protocol
