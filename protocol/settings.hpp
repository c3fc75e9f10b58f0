/// A map's settings: said when it is created, the first line of a script, part of `joined`. Only
/// layers change later, by numbered changes (layer_change.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"

namespace earthwork::protocol {

struct LayerSettings {
  std::string name = "ground";
  std::string color = "#8a9a5b";  ///< "#rrggbb", lower case.
  double bottom = -1, top = 0;    ///< Of its walls, in map units; bottom < top.
  friend bool operator==(const LayerSettings&, const LayerSettings&) = default;
};

/// Ranges: chunk_resolution 8, 16, 32 or 64; chunks [cx0, cy0, cx1, cy1), not empty, inside the
/// world of kWorldVoxels either way, or none; voxel_size finite, 1e-6 .. 1e6; max_feature_angle
/// 0 < a <= 175 degrees; 1 .. 16 layers.
struct MapSettings {
  int chunk_resolution = 32;
  std::optional<std::array<std::int32_t, 4>> chunks;
  double voxel_size = 1;
  double max_feature_angle = 135;
  std::vector<LayerSettings> layers{1};
  friend bool operator==(const MapSettings&, const MapSettings&) = default;
};

/// Reads what a script's first line has under "map", and POST /api/maps under "settings". What is
/// missing takes its default, unknown keys are ignored, "wall": [bottom, top] is short for one
/// layer. Fails with bad_field or out_of_range.
[[nodiscard]] Result<MapSettings> read_settings(const nlohmann::json& json);
/// Always with "layers", "chunks" only for a bounded map.
[[nodiscard]] nlohmann::json write_settings(const MapSettings& settings);

/// 1-64 of a-z, 0-9, '-', '_'.
[[nodiscard]] bool valid_map_name(std::string_view name);

}  // namespace earthwork::protocol
