#include "server/net/map_figures.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "protocol/chunk_record.hpp"

namespace earthwork::net {

using nlohmann::ordered_json;

namespace {

ordered_json by_case(const std::array<std::uint64_t, 16>& counts) {
  ordered_json out = ordered_json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) out[std::to_string(i)] = counts[i];
  return out;
}

}  // namespace

ordered_json write_figures(const room::RoomFigures& figures, int resolution) {
  const mesh::Figures& g = figures.geometry;
  const auto voxels = static_cast<double>(figures.chunks) * resolution * resolution;
  return {
      {"seq", figures.seq},
      {"hash", protocol::hex(figures.hash)},
      {"mesh_hash", protocol::hex(figures.meshes.hash)},
      {"surface_area", g.surface_area},
      {"wall_length", g.wall_length},
      {"wall_sections", g.wall_sections},
      {"degenerate_wall_sections", g.degenerate_wall_sections},
      {"sharp_features", g.sharp_features},
      {"clamped_features", g.clamped_features},
      {"diagonal_connections", g.diagonal_connections},
      {"cells_by_case", by_case(g.cells_by_case)},
      {"filled_voxels", g.filled_voxels},
      {"edits", figures.seq},
      {"borderline_cells", 0},  // every decision is made on integers
      {"triangles", figures.meshes.triangles},
      {"vertices", figures.meshes.vertices},
      {"chunks", figures.chunks},
      {"meshed_chunks", figures.meshes.chunks},
      {"voxel_bytes", figures.voxel_bytes},
      {"mesh_bytes", figures.meshes.bytes},
      {"bytes_per_voxel", voxels > 0 ? static_cast<double>(figures.voxel_bytes) / voxels : 0.0}};
}

}  // namespace earthwork::net
