// Changes of layers: what a message may ask for, what a map takes, and what comes of it.
#include "protocol/layer_change.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "protocol/limits.hpp"
#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

std::string refusal(const char* text) {
  const auto read = read_layer_change(json::parse(text));
  if (read) return "good";
  return std::string(name(read.error().code)) + ": " + read.error().detail;
}

MapSettings with_layers(std::size_t count) {
  MapSettings settings;
  settings.layers.assign(count, {.name = "old", .color = "#010203", .bottom = -2, .top = 3});
  return settings;
}

std::string checked(const LayerChange& change, std::size_t layers) {
  const auto result = check_layer_change(change, with_layers(layers));
  if (result) return "good";
  EXPECT_EQ(result.error().field, "layer");
  return std::string(name(result.error().code)) + ": " + result.error().detail;
}

LayerChange of_layer(std::optional<std::uint32_t> layer) {
  return {.layer = layer, .name = "new", .color = {}, .wall = {}};
}

RC_GTEST_PROP(LayerChange, ReadsWhatItWrites, ()) {
  const LayerChange change = *any_layer_change();
  nlohmann::ordered_json written = nlohmann::ordered_json::object();
  write_layer_change(change, written);
  RC_ASSERT(read_layer_change(json::parse(written.dump())) == change);
}

TEST(LayerChange, NeedsNothingToAddALayerAndSomethingToChangeOne) {
  EXPECT_EQ(read_layer_change(json::object()), LayerChange{});
  EXPECT_EQ(refusal(R"({"layer":0})"), "bad_field: layer: nothing of it is changed");
  EXPECT_EQ(refusal(R"({"layer":0,"note":"x"})"), "bad_field: layer: nothing of it is changed");
  EXPECT_EQ(refusal(R"({"layer":0,"name":"a"})"), "good");
  EXPECT_EQ(refusal(R"({"layer":0,"color":"#AABBCC"})"), "good");
  EXPECT_EQ(refusal(R"({"layer":0,"wall":[0,1]})"), "good");
}

TEST(LayerChange, BoundsItsFields) {
  EXPECT_EQ(refusal(R"({"layer":15,"name":"a"})"), "good");
  EXPECT_EQ(refusal(R"({"layer":16,"name":"a"})"), "out_of_range: layer: is outside 0 .. 15");
  EXPECT_EQ(refusal(R"({"layer":-1,"name":"a"})"), "out_of_range: layer: is outside 0 .. 15");
  EXPECT_EQ(refusal(R"({"layer":"0"})"), "bad_field: layer: is not an integer");
  EXPECT_EQ(refusal(("{\"name\":\"" + std::string(64, 'x') + "\"}").c_str()), "good");
  EXPECT_NE(refusal(("{\"name\":\"" + std::string(65, 'x') + "\"}").c_str()), "good");
  EXPECT_NE(refusal(R"({"name":""})"), "good");
  EXPECT_NE(refusal(R"({"color":"red"})"), "good");
  EXPECT_EQ(refusal(R"({"wall":[-1000000,1000000]})"), "good");
  EXPECT_NE(refusal(R"({"wall":[-1000001,0]})"), "good");
  EXPECT_NE(refusal(R"({"wall":[1,1]})"), "good");
  EXPECT_NE(refusal(R"({"wall":[2,1]})"), "good");
}

TEST(LayerChange, IsForALayerThatIsThere) {
  EXPECT_EQ(checked(of_layer(2), 3), "good");
  EXPECT_EQ(checked(of_layer(3), 3), "out_of_range: layer: 3 of a map with 3 layers");
}

TEST(LayerChange, AddsSixteenLayersAndNotOneMore) {
  EXPECT_EQ(checked(of_layer({}), 15), "good");
  EXPECT_EQ(checked(of_layer({}), 16), "too_large: layer: a map has at most 16 layers");
}

TEST(LayerChange, AddsALayerThatIsCalledByItsNumber) {
  MapSettings settings = with_layers(2);
  apply(LayerChange{}, settings);
  ASSERT_EQ(settings.layers.size(), 3u);
  const LayerSettings plain;
  EXPECT_EQ(
      settings.layers[2],
      (LayerSettings{
          .name = "layer 3", .color = plain.color, .bottom = plain.bottom, .top = plain.top}));
  apply({.layer = {}, .name = "roof", .color = "#ffffff", .wall = {{4, 4.5}}}, settings);
  EXPECT_EQ(settings.layers[3],
            (LayerSettings{.name = "roof", .color = "#ffffff", .bottom = 4, .top = 4.5}));
}

TEST(LayerChange, LeavesWhatItDoesNotSay) {
  MapSettings settings = with_layers(2);
  apply(of_layer(1), settings);
  EXPECT_EQ(settings.layers[1],
            (LayerSettings{.name = "new", .color = "#010203", .bottom = -2, .top = 3}));
  apply({.layer = 1, .name = {}, .color = "#0a0b0c", .wall = {}}, settings);
  apply({.layer = 1, .name = {}, .color = {}, .wall = {{0, 9}}}, settings);
  EXPECT_EQ(settings.layers[1],
            (LayerSettings{.name = "new", .color = "#0a0b0c", .bottom = 0, .top = 9}));
  EXPECT_EQ(settings.layers[0], with_layers(2).layers[0]);
}

// Whatever is accepted gives settings that can be read again.
RC_GTEST_PROP(LayerChange, KeepsSettingsValid, ()) {
  MapSettings settings = *any_settings();
  for (int i = 0; i < 20; ++i) {
    const LayerChange change = *any_layer_change();
    if (check_layer_change(change, settings)) apply(change, settings);
  }
  RC_ASSERT(settings.layers.size() <= kMaxLayers);
  RC_ASSERT(read_settings(json::parse(write_settings(settings).dump())) == settings);
}

}  // namespace
}  // namespace earthwork::protocol
