// Settings that are accepted keep every promise of MapSettings, and survive the way out and in.
#include "protocol/settings.hpp"

#include <nlohmann/json.hpp>

#include "protocol/chunk_range.hpp"
#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {
namespace {

void check_promises(const MapSettings& settings) {
  expect(settings.voxel_size >= 1e-6 && settings.voxel_size <= 1e6, "voxel size");
  expect(settings.max_feature_angle > 0 && settings.max_feature_angle <= 175, "feature angle");
  expect(!settings.layers.empty() && settings.layers.size() <= kMaxLayers, "layers");
  for (const LayerSettings& layer : settings.layers) {
    expect(layer.bottom < layer.top, "bottom below top");
    expect(layer.color.size() == 7 && !layer.name.empty(), "name and colour");
  }
  const ChunkRange extent = map_extent(settings);
  expect(!extent.empty(), "a map has a chunk");
  const std::int32_t world = kWorldVoxels / settings.chunk_resolution;
  expect(extent.x0 >= -world && extent.y1 <= world, "a map lies inside the world");
}

void check(std::string_view text) {
  const auto json = parse_json(text, kMaxControlBytes);
  if (!json) return;
  const auto settings = read_settings(*json);
  if (!settings) {
    expect(!settings.error().detail.empty(), "a refusal says why");
    return;
  }
  check_promises(*settings);
  const auto again = read_settings(nlohmann::json::parse(write_settings(*settings).dump()));
  expect(again && *again == *settings, "read(write(s)) = s");
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check(earthwork::text_of(data, size));
  return 0;
}
