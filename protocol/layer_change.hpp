/// A change of a map's layers: one more, or another name, colour or height for one there is. It is
/// numbered among the edits.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

struct LayerChange {
  std::optional<std::uint32_t> layer;         ///< The index of the one to change; none: adds one.
  std::optional<std::string> name, color;     ///< As of LayerSettings.
  std::optional<std::array<double, 2>> wall;  ///< [bottom, top], as of LayerSettings.
  friend bool operator==(const LayerChange&, const LayerChange&) = default;
};

/// Reads the fields of a `layer` message or a line of a recording: {layer?, name?, color?, wall?}.
/// Unknown keys are ignored. To change a layer something of it must be said.
[[nodiscard]] Result<LayerChange> read_layer_change(const nlohmann::json& json);
/// The fields of `change`, added to the object.
void write_layer_change(const LayerChange& change, nlohmann::ordered_json& out);

/// The layer is there, or one more may be. A recorded change is never checked again.
[[nodiscard]] Result<void> check_layer_change(const LayerChange& change,
                                              const MapSettings& settings);
/// Makes an accepted change. What is not said of an added layer is "layer N", N counted from 1, and
/// otherwise as in settings that do not say it; of a changed one it stays.
void apply(const LayerChange& change, MapSettings& settings);

}  // namespace earthwork::protocol
