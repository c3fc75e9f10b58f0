#include "tests/mesh/script_map.hpp"

#include <fstream>
#include <stdexcept>

namespace earthwork::mesh {
namespace {

std::ifstream open(const std::string& file) {
  std::ifstream in(std::string(EARTHWORK_SOURCE_DIR) + "/tests/conformance/" + file);
  if (!in) throw std::runtime_error("cannot read tests/conformance/" + file);
  return in;
}

}  // namespace

Script read_script(const std::string& name) {
  std::ifstream in = open(name + ".jsonl");
  Script script;
  for (std::string line; std::getline(in, line);) {
    const auto json = nlohmann::json::parse(line);
    if (json.contains("map")) {
      const auto& map = json["map"];
      script.grid.resolution = map["chunk_resolution"];
      script.grid.voxel_size = map["voxel_size"];
      script.max_feature_angle = map["max_feature_angle"];
      const auto& c = map["chunks"];
      script.grid.bounds = voxel::ChunkRect{c[0], c[1], c[2], c[3]};
      continue;
    }
    const bool square = json["stencil"] == "square";
    script.edits.push_back({.x = json["x"],
                            .y = json["y"],
                            .radius = json["radius"],
                            .shape = square ? voxel::Shape::square : voxel::Shape::circle,
                            .fill = json["fill"] ? voxel::Fill::filled : voxel::Fill::empty});
  }
  return script;
}

nlohmann::json read_expected() { return nlohmann::json::parse(open("expected.json")); }

std::optional<voxel::Grid> rechunked(const voxel::Grid& grid, int resolution) {
  voxel::Grid result = grid;
  result.resolution = resolution;
  for (std::int32_t* edge :
       {&result.bounds->x0, &result.bounds->y0, &result.bounds->x1, &result.bounds->y1}) {
    const std::int32_t voxels = *edge * grid.resolution;
    if (voxels % resolution != 0) return std::nullopt;
    *edge = voxels / resolution;
  }
  return result;
}

voxel::Map play(const voxel::Grid& grid, const std::vector<voxel::Stencil>& edits) {
  voxel::Map map(grid);
  for (const voxel::Stencil& edit : edits) map.apply(0, {&edit, 1});
  return map;
}

}  // namespace earthwork::mesh
