/// An edit: one stencil, stamped at one place or along a path.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "protocol/json_fields.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

enum class StencilShape : std::uint8_t { square, circle };

/// "square" or "circle".
[[nodiscard]] std::string_view name(StencilShape shape);
/// The field "stencil".
[[nodiscard]] StencilShape read_stencil(JsonFields& in);

/// Map units.
struct MapPoint {
  double x = 0, y = 0;
  friend bool operator==(const MapPoint&, const MapPoint&) = default;
};

struct Edit {
  std::uint32_t layer = 0;
  StencilShape stencil = StencilShape::circle;
  bool fill = true;
  double radius = 0;           ///< Map units.
  std::vector<MapPoint> path;  ///< Centres, stamped in order; at least one.
  bool is_path = false;        ///< Written as "path" rather than "x" and "y".
  std::optional<std::int64_t> stroke;
  friend bool operator==(const Edit&, const Edit&) = default;
};

/// Reads the fields of an `edit` message or a script line: {stencil, fill, x, y or path, radius,
/// layer?, stroke?}. Unknown keys are ignored. Everything is finite, the path has 1 .. 1,024
/// points, the radius is >= 0; limits that depend on the map are `check_edit`'s.
[[nodiscard]] Result<Edit> read_edit(const nlohmann::json& json);
/// The fields of `edit`, added to the object; layer 0 is not written.
void write_edit(const Edit& edit, nlohmann::ordered_json& out);

/// The limits of an edit that arrives for a map with these settings: those of check_layer and of
/// check_stamps, in this order. A recorded edit is never checked again.
[[nodiscard]] Result<void> check_edit(const Edit& edit, const MapSettings& settings);
/// The map has the layer. It may have it later.
[[nodiscard]] Result<void> check_layer(const Edit& edit, const MapSettings& settings);
/// Radius and coordinates in voxels, voxel visits and chunks, in this order: what a map's layers
/// have no part in.
[[nodiscard]] Result<void> check_stamps(const Edit& edit, const MapSettings& settings);

}  // namespace earthwork::protocol
