#include "protocol/edit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "protocol/limits.hpp"
#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

json circle() {
  return {{"stencil", "circle"}, {"fill", true}, {"x", 1}, {"y", -2.5}, {"radius", 3}};
}

/// "code: detail" of a circle with one field set to something else, or "good".
std::string verdict(const char* field, json value) {
  json edit = circle();
  edit[field] = std::move(value);
  const auto read = read_edit(edit);
  if (read) return "good";
  EXPECT_EQ(read.error().detail.rfind(read.error().field, 0), 0u) << "names its field";
  return std::string(name(read.error().code)) + ": " + read.error().detail;
}

TEST(Edit, ReadsACentre) {
  const auto read = read_edit(circle());
  ASSERT_TRUE(read);
  Edit expected;
  expected.radius = 3;
  expected.path = {{1, -2.5}};
  EXPECT_EQ(*read, expected);
}

TEST(Edit, ReadsAPathLayerAndStroke) {
  const auto read = read_edit(json::parse(
      R"({"stencil":"square","fill":false,"path":[[0,1],[2.5,3]],"radius":0,"layer":15,
          "stroke":-4,"note":"ignored"})"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->stencil, StencilShape::square);
  EXPECT_FALSE(read->fill);
  EXPECT_EQ(read->path, (std::vector<MapPoint>{{0, 1}, {2.5, 3}}));
  EXPECT_TRUE(read->is_path);
  EXPECT_EQ(read->layer, 15u);
  EXPECT_EQ(read->stroke, -4);
}

TEST(Edit, TakesTypesAsTheyStand) {
  EXPECT_EQ(verdict("fill", 1), "bad_field: fill: is not true or false");
  EXPECT_EQ(verdict("fill", "true"), "bad_field: fill: is not true or false");
  EXPECT_EQ(verdict("fill", nullptr), "bad_field: fill: is missing");
  EXPECT_EQ(verdict("x", "1"), "bad_field: x: is not a number");
  EXPECT_EQ(verdict("y", true), "bad_field: y: is not a number");
  EXPECT_EQ(verdict("layer", 1.0), "bad_field: layer: is not an integer");
  EXPECT_EQ(verdict("layer", -1), "out_of_range: layer: is outside 0 .. 15");
  EXPECT_EQ(verdict("layer", 16), "out_of_range: layer: is outside 0 .. 15");
  EXPECT_EQ(verdict("layer", UINT64_MAX), "out_of_range: layer: is outside 0 .. 15");
  EXPECT_EQ(verdict("stencil", "star"), "bad_field: stencil: is not \"square\" or \"circle\"");
  EXPECT_EQ(verdict("stencil", 3), "bad_field: stencil: is not a string");
  EXPECT_EQ(verdict("radius", -0.5), "out_of_range: radius: is below 0");
  EXPECT_EQ(verdict("radius", 0), "good");
  EXPECT_EQ(verdict("stroke", 1.5), "bad_field: stroke: is not an integer");
  EXPECT_EQ(verdict("stroke", kMaxInteger), "good");
  EXPECT_NE(verdict("stroke", kMaxInteger + 1), "good");
}

TEST(Edit, NamesWhatIsMissing) {
  for (const char* field : {"stencil", "fill", "x", "y", "radius"}) {
    json edit = circle();
    edit.erase(field);
    const auto read = read_edit(edit);
    ASSERT_FALSE(read) << field;
    EXPECT_EQ(read.error().detail, std::string(field) + ": is missing");
    EXPECT_EQ(read.error().field, field);
  }
}

TEST(Edit, TakesAPathOfUpTo1024Points) {
  json edit = {{"stencil", "circle"}, {"fill", true}, {"radius", 3}};
  edit["path"] = json::array();
  EXPECT_EQ(read_edit(edit).error().detail, "path: 0 elements are outside 1 .. 1024");
  for (int i = 0; i < 1024; ++i) edit["path"].push_back({i, 0});
  EXPECT_TRUE(read_edit(edit));
  edit["path"].push_back({0, 0});
  EXPECT_EQ(read_edit(edit).error().detail, "path: 1025 elements are outside 1 .. 1024");
}

TEST(Edit, NamesAPointThatIsNone) {
  json edit = {{"stencil", "circle"}, {"fill", true}, {"radius", 3}};
  for (const char* points : {"[[0,0],[1]]", "[[0,0],[1,2,3]]", "[[0,0],[1,\"2\"]]", "[[0,0],7]"}) {
    edit["path"] = json::parse(points);
    const auto read = read_edit(edit);
    ASSERT_FALSE(read) << points;
    EXPECT_EQ(read.error().detail, "path: element 1 is not a point [x, y]");
  }
  edit["path"] = json::parse("[[0,0]]");
  edit["x"] = 1;
  EXPECT_EQ(read_edit(edit).error().detail, "path: stands in place of x and y, not beside them");
}

RC_GTEST_PROP(Edit, SurvivesTheRoundTrip, ()) {
  const Edit edit = *any_edit();
  nlohmann::ordered_json out;
  write_edit(edit, out);
  const auto read = read_edit(json::parse(out.dump()));
  RC_ASSERT(read.has_value());
  RC_ASSERT(*read == edit);
}

}  // namespace
}  // namespace earthwork::protocol
