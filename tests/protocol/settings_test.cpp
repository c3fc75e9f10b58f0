#include "protocol/settings.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

/// "code: detail", or "good".
std::string verdict(const char* text) {
  const auto read = read_settings(json::parse(text));
  if (read) return "good";
  return std::string(name(read.error().code)) + ": " + read.error().detail;
}

TEST(Settings, DefaultWhereNothingIsSaid) {
  const auto read = read_settings(json::object());
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, MapSettings{});
  EXPECT_EQ(read->chunk_resolution, 32);
  EXPECT_EQ(read->chunks, std::nullopt);
  ASSERT_EQ(read->layers.size(), 1u);
  EXPECT_EQ(read->layers[0].bottom, -1);
}

TEST(Settings, ReadEveryField) {
  const auto read = read_settings(json::parse(R"({"chunk_resolution":8,"chunks":[-1,-2,3,4],
    "voxel_size":0.25,"max_feature_angle":90,"kind":"2d","note":"ignored",
    "layers":[{"name":"Wasser 水","color":"#AABBCC","wall":[-2,-1.5]},{}]})"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->chunk_resolution, 8);
  EXPECT_EQ(read->chunks, (std::array<std::int32_t, 4>{-1, -2, 3, 4}));
  EXPECT_EQ(read->voxel_size, 0.25);
  EXPECT_EQ(read->max_feature_angle, 90);
  ASSERT_EQ(read->layers.size(), 2u);
  EXPECT_EQ(read->layers[0], (LayerSettings{"Wasser 水", "#aabbcc", -2, -1.5}));
  EXPECT_EQ(read->layers[1], LayerSettings{});
}

TEST(Settings, TakeWallAsShortForOneLayer) {
  const auto read = read_settings(json::parse(R"({"wall":[0,2.5]})"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->layers, (std::vector<LayerSettings>{{"ground", "#8a9a5b", 0, 2.5}}));
  EXPECT_EQ(verdict(R"({"wall":[0,1],"layers":[{}]})"),
            "bad_field: wall: is short for one layer and does not go with layers");
}

TEST(Settings, NameTheFieldThatIsWrong) {
  EXPECT_EQ(verdict("[]"), "bad_field: not a JSON object");
  EXPECT_EQ(verdict(R"({"chunk_resolution":24})"),
            "out_of_range: chunk_resolution: is not 8, 16, 32 or 64");
  EXPECT_EQ(verdict(R"({"chunk_resolution":32.0})"),
            "bad_field: chunk_resolution: is not an integer");
  EXPECT_EQ(verdict(R"({"voxel_size":"1"})"), "bad_field: voxel_size: is not a number");
  EXPECT_EQ(verdict(R"({"chunks":[0,0,1]})"), "bad_field: chunks: 3 elements are not 4");
  EXPECT_EQ(verdict(R"({"chunks":[0,0,1,true]})"),
            "bad_field: chunks: element 3 is not an integer");
  EXPECT_EQ(verdict(R"({"layers":[{},{"color":"red"}]})"),
            "bad_field: layers[1].color: is not a colour like \"#8a9a5b\"");
  EXPECT_EQ(verdict(R"({"layers":[{"name":""}]})"),
            "out_of_range: layers[0].name: has 0 characters, outside 1 .. 64");
  EXPECT_EQ(verdict(R"({"layers":[7]})"), "bad_field: layers[0]: not a JSON object");
  EXPECT_EQ(verdict(R"({"kind":"3d"})"), "not_supported: kind: only \"2d\" is offered");
}

TEST(Settings, KeepChunksInsideTheWorld) {
  EXPECT_EQ(verdict(R"({"chunk_resolution":64,"chunks":[-15634,-15634,15634,15634]})"), "good");
  EXPECT_EQ(verdict(R"({"chunk_resolution":64,"chunks":[-15635,0,1,1]})"),
            "out_of_range: chunks: reaches beyond -15634 .. 15634, which is 1000576 voxels");
  EXPECT_EQ(verdict(R"({"chunk_resolution":8,"chunks":[0,0,125072,1]})"), "good");
  EXPECT_NE(verdict(R"({"chunk_resolution":8,"chunks":[0,0,125073,1]})"), "good");
  EXPECT_EQ(verdict(R"({"chunks":[0,0,0,1]})"),
            "out_of_range: chunks: [cx0, cy0, cx1, cy1] needs cx0 < cx1 and cy0 < cy1");
  EXPECT_EQ(verdict(R"({"chunks":[0,0,99999999999,1]})"),
            "out_of_range: chunks: element 2 is outside -2147483648 .. 2147483647");
}

TEST(Settings, BoundVoxelsAnglesAndHeights) {
  EXPECT_EQ(verdict(R"({"voxel_size":1e-6})"), "good");
  EXPECT_EQ(verdict(R"({"voxel_size":1e6})"), "good");
  EXPECT_EQ(verdict(R"({"voxel_size":0})"),
            "out_of_range: voxel_size: 0 is outside 1e-06 .. 1000000");
  EXPECT_NE(verdict(R"({"voxel_size":1000001})"), "good");
  EXPECT_EQ(verdict(R"({"max_feature_angle":175})"), "good");
  EXPECT_EQ(verdict(R"({"max_feature_angle":175.1})"),
            "out_of_range: max_feature_angle: 175.1 is outside 0 .. 175");
  EXPECT_EQ(verdict(R"({"max_feature_angle":0})"),
            "out_of_range: max_feature_angle: is not more than 0 degrees");
  EXPECT_EQ(verdict(R"({"wall":[-1000000,1000000]})"), "good");
  EXPECT_EQ(verdict(R"({"wall":[0,1000001]})"),
            "out_of_range: wall: a height is beyond the limit of 1000000");
  EXPECT_NE(verdict(R"({"wall":[1,1]})"), "good");
  EXPECT_NE(verdict(R"({"wall":[1,1.00000000001]})"), "good") << "equal as 32-bit floats";
  EXPECT_NE(verdict(R"({"wall":[0.99999999999,1]})"), "good") << "likewise";
}

TEST(Settings, TakeSixteenLayersAndNotSeventeen) {
  json settings;
  settings["layers"] = json::array();
  EXPECT_FALSE(read_settings(settings));
  for (int i = 0; i < 16; ++i) settings["layers"].push_back(json::object());
  EXPECT_TRUE(read_settings(settings));
  settings["layers"].push_back(json::object());
  const auto read = read_settings(settings);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().detail, "layers: 17 elements are outside 1 .. 16");
}

TEST(Settings, CountNamesInCharacters) {
  std::string name;
  for (int i = 0; i < 64; ++i) name += "水";
  EXPECT_TRUE(read_settings({{"layers", {{{"name", name}}}}}));
  EXPECT_FALSE(read_settings({{"layers", {{{"name", name + "a"}}}}}));
  for (const char* bad : {"a\nb", "\x1f", "\x7f", "\xc2\x85", "\xc2\x9f"})
    EXPECT_FALSE(read_settings({{"layers", {{{"name", bad}}}}}));
  EXPECT_TRUE(read_settings({{"layers", {{{"name", "\xc2\xa0"}}}}}));
}

TEST(Settings, WriteChunksOnlyForABoundedMap) {
  MapSettings settings;
  EXPECT_FALSE(write_settings(settings).contains("chunks"));
  settings.chunks = {0, 0, 2, 2};
  EXPECT_EQ(write_settings(settings)["chunks"], json({0, 0, 2, 2}));
}

RC_GTEST_PROP(Settings, SurviveTheRoundTrip, ()) {
  const MapSettings settings = *any_settings();
  const auto read = read_settings(json::parse(write_settings(settings).dump()));
  RC_ASSERT(read.has_value());
  RC_ASSERT(*read == settings);
}

TEST(MapName, IsOneToSixtyFourPlainCharacters) {
  EXPECT_TRUE(valid_map_name("a"));
  EXPECT_TRUE(valid_map_name("demo-2_x"));
  EXPECT_TRUE(valid_map_name(std::string(64, 'z')));
  EXPECT_FALSE(valid_map_name(""));
  EXPECT_FALSE(valid_map_name(std::string(65, 'z')));
  for (const char* bad : {"A", "a b", "a.b", "a/b", "é", "a\n"}) EXPECT_FALSE(valid_map_name(bad));
}

}  // namespace
}  // namespace earthwork::protocol
