// What is accepted is an edit or a change of layers, and says which.
#include "protocol/action.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

const LayerChange kRename{.layer = 1, .name = "roof", .color = {}, .wall = {}};
const Edit kStamp{.layer = 1, .radius = 2, .path = {{3, 4}}, .stroke = {}};

RC_GTEST_PROP(Action, ReadsWhatItWrites, ()) {
  const Action action = *any_action();
  nlohmann::ordered_json written;
  write_action(action, written);
  RC_ASSERT(written.begin().key() == "kind");
  RC_ASSERT(read_action(json::parse(written.dump())) == action);
  nlohmann::ordered_json fields = nlohmann::ordered_json::object();
  write_fields(action, fields);
  RC_ASSERT(read_action(json::parse(fields.dump()), kind(action)) == action);
}

TEST(Action, SaysItsKind) {
  EXPECT_EQ(kind(kStamp), "edit");
  EXPECT_EQ(kind(kRename), "layer");
  nlohmann::ordered_json written;
  write_action(kRename, written);
  EXPECT_EQ(written.dump(), R"({"kind":"layer","layer":1,"name":"roof"})");
}

TEST(Action, IsAnEditWhereNoKindIsSaid) {
  const auto read =
      read_action(json::parse(R"({"stencil":"circle","fill":true,"x":3,"y":4,"radius":2})"));
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_TRUE(std::holds_alternative<Edit>(*read));
}

TEST(Action, RefusesAKindThatIsNotKnown) {
  const auto refusal = [](const char* text) {
    const auto read = read_action(json::parse(text));
    return read ? "good" : std::string(name(read.error().code)) + ": " + read.error().detail;
  };
  EXPECT_EQ(refusal(R"({"kind":"undo"})"), "not_supported: kind: is not known here");
  EXPECT_EQ(refusal(R"({"kind":7})"), "bad_field: kind: is not a string");
  EXPECT_EQ(refusal(R"({"kind":"layer","layer":0})"), "bad_field: layer: nothing of it is changed");
  EXPECT_EQ(refusal(R"({"kind":"edit"})"), "bad_field: stencil: is missing");
}

TEST(Action, IsCheckedAgainstTheLayersThatThereAre) {
  MapSettings settings;
  for (const Action& action : {Action(kStamp), Action(kRename)}) {
    EXPECT_EQ(check_layers(action, settings).error().code, Code::out_of_range);
    EXPECT_EQ(check_action(action, settings).error().field, "layer");
  }
  protocol::apply(Action(LayerChange{}), settings);
  for (const Action& action : {Action(kStamp), Action(kRename)})
    EXPECT_TRUE(check_action(action, settings));
}

TEST(Action, IsCheckedForItsStampsToo) {
  Edit huge = kStamp;
  huge.layer = 0, huge.radius = 513;
  EXPECT_TRUE(check_layers(huge, {}));
  EXPECT_EQ(check_action(huge, {}).error().field, "radius");
}

TEST(Action, OfAnEditLeavesTheSettings) {
  MapSettings settings;
  protocol::apply(Action(kStamp), settings);
  EXPECT_EQ(settings, MapSettings{});
}

TEST(Action, CountsItsPoints) {
  Edit path = kStamp;
  path.path.assign(7, {0, 0});
  EXPECT_EQ(points(path), 7u);
  EXPECT_EQ(points(kRename), 1u);
}

}  // namespace
}  // namespace earthwork::protocol
