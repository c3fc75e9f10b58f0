#include "protocol/settings.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "protocol/chunk_range.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/wall_heights.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

constexpr double kMaxVoxelSize = 1e6, kMinVoxelSize = 1e-6;
constexpr double kMaxFeatureAngle = 175;

int read_resolution(JsonFields& in) {
  const auto resolution = in.integer("chunk_resolution");
  if (resolution != 8 && resolution != 16 && resolution != 32 && resolution != 64)
    in.refuse(Code::out_of_range, "chunk_resolution", "is not 8, 16, 32 or 64");
  return static_cast<int>(resolution);
}

std::array<std::int32_t, 4> read_chunks(JsonFields& in, int resolution) {
  const auto read = in.integers("chunks", 4, {INT32_MIN, INT32_MAX});
  std::array<std::int32_t, 4> chunks{};
  for (std::size_t i = 0; i < 4; ++i) chunks[i] = static_cast<std::int32_t>(read[i]);
  if (in.failed()) return chunks;
  if (chunks[0] >= chunks[2] || chunks[1] >= chunks[3]) {
    in.refuse(Code::out_of_range, "chunks", "[cx0, cy0, cx1, cy1] needs cx0 < cx1 and cy0 < cy1");
    return chunks;
  }
  MapSettings unbounded;
  unbounded.chunk_resolution = resolution;
  const ChunkRange world = map_extent(unbounded);
  if (chunks[0] < world.x0 || chunks[1] < world.y0 || chunks[2] > world.x1 || chunks[3] > world.y1)
    in.refuse(Code::out_of_range, "chunks",
              "reaches beyond " + std::to_string(world.x0) + " .. " + std::to_string(world.x1) +
                  ", which is " + std::to_string(kWorldVoxels) + " voxels");
  return chunks;
}

void read_wall(JsonFields& in, LayerSettings& layer) {
  const auto wall = read_wall_heights(in);
  if (in.failed()) return;
  layer.bottom = wall[0];
  layer.top = wall[1];
}

LayerSettings read_layer(JsonFields in, std::optional<Failure>& failure) {
  LayerSettings layer;
  if (in.has("name")) layer.name = in.name("name");
  if (in.has("color")) layer.color = in.color("color");
  if (in.has("wall")) read_wall(in, layer);
  auto result = in.result(std::move(layer));
  if (result) return std::move(*result);
  failure = std::move(result.error());
  return {};
}

std::vector<LayerSettings> read_layers(JsonFields& in) {
  std::vector<LayerSettings> layers;
  const json* array = in.array("layers", 1, kMaxLayers);
  if (!array) return layers;
  for (const json& element : *array) {
    std::optional<Failure> failure;
    const std::string parent = in.path("layers[" + std::to_string(layers.size()) + "]");
    layers.push_back(read_layer(JsonFields(element, parent), failure));
    if (failure) in.refuse(std::move(*failure));
  }
  return layers;
}

double read_within(JsonFields& in, const char* key, double min, double max) {
  const double value = in.number(key);
  if (!in.failed() && (value < min || value > max))
    in.refuse(Code::out_of_range, key,
              plain(value) + " is outside " + plain(min) + " .. " + plain(max));
  return value;
}

}  // namespace

std::array<double, 2> read_wall_heights(JsonFields& in) {
  const auto wall = in.numbers("wall", 2);
  if (in.failed()) return {};
  if (std::max(std::abs(wall[0]), std::abs(wall[1])) > kMaxHeight)
    in.refuse(Code::out_of_range, "wall", "a height is beyond the limit of " + plain(kMaxHeight));
  else if (static_cast<float>(wall[0]) >= static_cast<float>(wall[1]))
    in.refuse(Code::out_of_range, "wall",
              "[bottom, top] needs bottom < top, also as 32-bit floats");
  return {wall[0], wall[1]};
}

Result<MapSettings> read_settings(const json& json) {
  JsonFields in(json);
  MapSettings settings;
  if (in.has("kind") && in.text("kind") != "2d")
    in.refuse(Code::not_supported, "kind", "only \"2d\" is offered");
  if (in.has("chunk_resolution")) settings.chunk_resolution = read_resolution(in);
  if (!in.failed() && in.has("chunks"))
    settings.chunks = read_chunks(in, settings.chunk_resolution);
  if (in.has("voxel_size"))
    settings.voxel_size = read_within(in, "voxel_size", kMinVoxelSize, kMaxVoxelSize);
  if (in.has("max_feature_angle")) {
    settings.max_feature_angle = read_within(in, "max_feature_angle", 0, kMaxFeatureAngle);
    if (settings.max_feature_angle <= 0)
      in.refuse(Code::out_of_range, "max_feature_angle", "is not more than 0 degrees");
  }
  if (in.has("layers") && in.has("wall"))
    in.refuse(Code::bad_field, "wall", "is short for one layer and does not go with layers");
  else if (in.has("layers"))
    settings.layers = read_layers(in);
  else if (in.has("wall"))
    read_wall(in, settings.layers[0]);
  return in.result(std::move(settings));
}

json write_settings(const MapSettings& settings) {
  json out{{"chunk_resolution", settings.chunk_resolution},
           {"voxel_size", settings.voxel_size},
           {"max_feature_angle", settings.max_feature_angle}};
  if (settings.chunks) out["chunks"] = *settings.chunks;
  json layers = json::array();
  for (const LayerSettings& layer : settings.layers)
    layers.push_back(
        {{"name", layer.name}, {"color", layer.color}, {"wall", {layer.bottom, layer.top}}});
  out["layers"] = std::move(layers);
  return out;
}

bool valid_map_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameBytes &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return ('a' <= c && c <= 'z') || ('0' <= c && c <= '9') || c == '-' || c == '_';
         });
}

}  // namespace earthwork::protocol
