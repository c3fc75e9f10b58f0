// Maps from the conformance scripts, for tests below the protocol.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/voxel/map.hpp"

namespace earthwork::mesh {

struct Script {
  voxel::Grid grid;
  double max_feature_angle = 135;
  std::vector<voxel::Stencil> edits;
};

/// Reads tests/conformance/NAME.jsonl; throws when it is not there.
Script read_script(const std::string& name);
/// tests/conformance/expected.json.
nlohmann::json read_expected();

/// The script's map cut into chunks of `resolution` voxels over the same ground, if that is a whole
/// number of them.
std::optional<voxel::Grid> rechunked(const voxel::Grid& grid, int resolution);

voxel::Map play(const voxel::Grid& grid, const std::vector<voxel::Stencil>& edits);

}  // namespace earthwork::mesh
