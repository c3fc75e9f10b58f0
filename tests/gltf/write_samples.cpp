// Writes GLB files of several kinds for Khronos' validator: write_samples FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "protocol/gltf/glb.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

bool write(const std::filesystem::path& path, const MapSettings& settings, const MeshMap& meshes) {
  const auto bytes = write_glb(settings, meshes);
  if (!bytes) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), bytes.error().detail.c_str());
    return false;
  }
  std::ofstream file(path, std::ios::binary);
  file.write(bytes->data(), static_cast<std::streamsize>(bytes->size()));
  return file.good();
}

bool write_all(const std::filesystem::path& folder) {
  const ChunkMesh square = square_mesh(), bend = bend_mesh(), band = band_mesh(2000);
  ChunkMesh surface_only = square, wall_only = square;
  surface_only.sections.clear();
  wall_only.triangles.clear();
  MapSettings one, three;
  three.voxel_size = 0.3;
  three.layers = {
      {"ground", "#8a9a5b", -1, 0}, {"empty", "#000000", 0, 1}, {"水", "#ffffff", 1, 2.7}};
  return write(folder / "empty.glb", one, {}) &&
         write(folder / "square.glb", one, {{{0, 0, 0, 0}, &square}}) &&
         write(folder / "parts.glb", one,
               {{{0, 0, 0, 0}, &surface_only}, {{0, 1, 0, 0}, &wall_only}}) &&
         write(folder / "layers.glb", three,
               {{{0, -1, -7, 0}, &bend}, {{0, 3, 0, 0}, &band}, {{2, 0, 0, 0}, &square}});
}

}  // namespace
}  // namespace earthwork::protocol

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_samples FOLDER\n", stderr);
    return 2;
  }
  std::filesystem::create_directories(arguments[1]);
  return earthwork::protocol::write_all(arguments[1]) ? 0 : 1;
}
