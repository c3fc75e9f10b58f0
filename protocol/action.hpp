/// What a map accepts and numbers: an edit of its voxels, or a change of its layers.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <variant>

#include "protocol/edit.hpp"
#include "protocol/layer_change.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

using Action = std::variant<Edit, LayerChange>;

/// "edit" or "layer", the field "kind" of events, recordings and scripts.
[[nodiscard]] std::string_view kind(const Action& action);

/// Reads the fields of an action of this kind; not_supported for one that is not known. What needs
/// a map is `check_action`'s.
[[nodiscard]] Result<Action> read_action(const nlohmann::json& json, std::string_view kind);
/// The same of the object's "kind", an edit without one.
[[nodiscard]] Result<Action> read_action(const nlohmann::json& json);

/// The fields of `action`, added to the object.
void write_fields(const Action& action, nlohmann::ordered_json& out);
/// The same after its kind.
void write_action(const Action& action, nlohmann::ordered_json& out);

/// The layers that it is for are there, or one more may be: `check_layer`, `check_layer_change`.
[[nodiscard]] Result<void> check_layers(const Action& action, const MapSettings& settings);
/// All limits of one that arrives for a map with these settings: also `check_stamps`.
[[nodiscard]] Result<void> check_action(const Action& action, const MapSettings& settings);

/// Centres that it stamps; of a change of layers 1. So it says what an action takes, about.
[[nodiscard]] std::size_t points(const Action& action);

/// What an accepted action makes of the settings: an edit leaves them.
void apply(const Action& action, MapSettings& settings);

}  // namespace earthwork::protocol
