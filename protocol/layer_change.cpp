#include "protocol/layer_change.hpp"

#include <nlohmann/json.hpp>

#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/wall_heights.hpp"

namespace earthwork::protocol {

Result<LayerChange> read_layer_change(const nlohmann::json& json) {
  JsonFields in(json);
  LayerChange change;
  if (in.has("layer"))
    change.layer = static_cast<std::uint32_t>(in.integer("layer", {0, kMaxLayers - 1}));
  if (in.has("name")) change.name = in.name("name");
  if (in.has("color")) change.color = in.color("color");
  if (in.has("wall")) change.wall = read_wall_heights(in);
  if (change.layer && !change.name && !change.color && !change.wall)
    in.refuse(Failure{Code::bad_field, "layer: nothing of it is changed", "layer"});
  return in.result(std::move(change));
}

void write_layer_change(const LayerChange& change, nlohmann::ordered_json& out) {
  if (change.layer) out["layer"] = *change.layer;
  if (change.name) out["name"] = *change.name;
  if (change.color) out["color"] = *change.color;
  if (change.wall) out["wall"] = *change.wall;
}

Result<void> check_layer_change(const LayerChange& change, const MapSettings& settings) {
  const std::size_t count = settings.layers.size();
  if (change.layer && *change.layer >= count)
    return fail(Code::out_of_range,
                "layer: " + std::to_string(*change.layer) + " of a map with " +
                    std::to_string(count) + " layers",
                "layer");
  if (!change.layer && count >= kMaxLayers)
    return fail(Code::too_large,
                "layer: a map has at most " + std::to_string(kMaxLayers) + " layers", "layer");
  return {};
}

void apply(const LayerChange& change, MapSettings& settings) {
  if (!change.layer) {
    LayerSettings added;
    added.name = "layer " + std::to_string(settings.layers.size() + 1);
    settings.layers.push_back(std::move(added));
  }
  LayerSettings& layer = change.layer ? settings.layers.at(*change.layer) : settings.layers.back();
  if (change.name) layer.name = *change.name;
  if (change.color) layer.color = *change.color;
  if (change.wall) {
    layer.bottom = (*change.wall)[0];
    layer.top = (*change.wall)[1];
  }
}

}  // namespace earthwork::protocol
