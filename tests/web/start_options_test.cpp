#include "client/viewer/web/start_options.hpp"

#include <gtest/gtest.h>

#include <string>

namespace earthwork::viewer {
namespace {

using protocol::Code;

void expect_refused(std::string_view json, Code code, std::string_view field) {
  const auto read = read_start_options(json);
  ASSERT_FALSE(read) << json;
  EXPECT_EQ(name(read.error().code), name(code)) << json;
  EXPECT_EQ(read.error().field, field) << json;
  EXPECT_NE(read.error().detail, "") << json;
}

TEST(StartOptions, AreReadWhole) {
  const auto read = read_start_options(R"({
    "map": "demo", "name": "Jö", "color": "#AABBCC", "key": "00112233445566778899aabbccddeeff",
    "last_id": 41, "seed": 7, "place": {"x": 1.5, "y": -2, "zoom": 8, "yaw": 0.5, "tilt": 1}})");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->map, "demo");
  EXPECT_EQ(read->hello.name, "Jö");
  EXPECT_EQ(read->hello.color, "#aabbcc");
  EXPECT_EQ(read->hello.key, "00112233445566778899aabbccddeeff");
  EXPECT_EQ(read->last_id, 41);
  EXPECT_EQ(read->seed, 7u);
  EXPECT_EQ(read->place,
            (scene::Camera::Place{.target = {1.5, -2}, .zoom = 8, .yaw = 0.5, .tilt = 1}));
}

TEST(StartOptions, NeedOnlyAMapAndAName) {
  const auto read = read_start_options(R"({"map":"demo","name":"Ann","key":null})");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->hello.color, std::nullopt);
  EXPECT_EQ(read->hello.key, std::nullopt);
  EXPECT_EQ(read->last_id, 0);
  EXPECT_EQ(read->place, std::nullopt);
}

TEST(StartOptions, OfAPlaceOnlyTheAnglesMayBeMissing) {
  const auto read = read_start_options(R"({"map":"a","name":"b","place":{"x":1,"y":2,"zoom":3}})");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->place, (scene::Camera::Place{.target = {1, 2}, .zoom = 3, .yaw = 0, .tilt = 0}));
  expect_refused(R"({"map":"a","name":"b","place":{"x":1,"y":2}})", Code::bad_field, "place.zoom");
  expect_refused(R"({"map":"a","name":"b","place":[1,2]})", Code::bad_field, "place");
}

TEST(StartOptions, AreRefusedWithTheFieldThatIsWrong) {
  expect_refused("", Code::bad_json, "");
  expect_refused(R"({"map":"a")", Code::bad_json, "");
  expect_refused(R"({"name":"b"})", Code::bad_field, "map");
  expect_refused(R"({"map":"No Such","name":"b"})", Code::bad_name, "map");
  expect_refused(R"({"map":"a","name":""})", Code::out_of_range, "name");
  expect_refused(R"({"map":"a","name":"b","color":"red"})", Code::bad_field, "color");
  expect_refused(R"({"map":"a","name":"b","key":"00"})", Code::bad_field, "key");
  expect_refused(R"({"map":"a","name":"b","last_id":-1})", Code::out_of_range, "last_id");
  expect_refused(R"({"map":"a","name":"b","seed":0.5})", Code::bad_field, "seed");
  expect_refused(R"({"map":"a","name":"b","place":{"x":0,"y":0,"zoom":0}})", Code::out_of_range,
                 "place.zoom");
}

TEST(StartOptions, AreBounded) {
  const std::string at_most = std::string(64, 'n');
  EXPECT_TRUE(read_start_options(R"({"map":"a","name":")" + at_most + "\"}"));
  expect_refused(R"({"map":"a","name":")" + at_most + "n\"}", Code::out_of_range, "name");
  expect_refused(std::string(64 * 1024 + 1, ' '), Code::too_large, "");
}

}  // namespace
}  // namespace earthwork::viewer
