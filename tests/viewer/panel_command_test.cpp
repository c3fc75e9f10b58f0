// What a page asks for: every command is read, and whatever is wrong names its field and bound.
#include "client/viewer/panel_command.hpp"

#include <gtest/gtest.h>

#include <string>

namespace earthwork::viewer {
namespace {

using protocol::Code;
using Action = MoveCamera::Action;

template <class Command>
Command read(std::string_view json) {
  const auto command = read_panel_command(json);
  EXPECT_TRUE(command) << json << ": " << (command ? "" : command.error().detail);
  if (!command || !std::holds_alternative<Command>(*command)) {
    ADD_FAILURE() << json << " is another command";
    return {};
  }
  return std::get<Command>(*command);
}

protocol::Failure refused(std::string_view json) {
  const auto command = read_panel_command(json);
  EXPECT_FALSE(command) << json;
  return command ? protocol::Failure{} : command.error();
}

TEST(PanelCommand, TakesAToolInHand) {
  EXPECT_EQ(read<UseTool>(R"({"do":"tool","tool":"move"})").tool, Tool::move);
  EXPECT_EQ(read<UseTool>(R"({"do":"tool","tool":"paint"})").tool, Tool::paint);
  EXPECT_EQ(refused(R"({"do":"tool","tool":"hammer"})").detail,
            R"(tool: is none of "paint" "move")");
}

TEST(PanelCommand, SetsWhatIsSaidOfTheBrush) {
  const auto all = read<SetBrush>(
      R"({"do":"brush","stencil":"square","fill":false,"radius":7.5,"layer":3,"snap":"lines"})");
  EXPECT_EQ(all.stencil, protocol::StencilShape::square);
  EXPECT_EQ(all.fill, false);
  EXPECT_EQ(all.radius_voxels, 7.5);
  EXPECT_EQ(all.layer, 3u);
  EXPECT_EQ(all.snap, scene::Snap::lines);
  const auto none = read<SetBrush>(R"({"do":"brush"})");
  EXPECT_FALSE(none.stencil || none.fill || none.radius_voxels || none.layer || none.snap);
}

TEST(PanelCommand, KeepsTheRadiusWithinItsBounds) {
  EXPECT_EQ(read<SetBrush>(R"({"do":"brush","radius":0})").radius_voxels, 0);
  EXPECT_EQ(read<SetBrush>(R"({"do":"brush","radius":50})").radius_voxels, 50);
  for (const char* json : {R"({"do":"brush","radius":50.001})", R"({"do":"brush","radius":-1})"}) {
    const auto why = refused(json);
    EXPECT_EQ(why.code, Code::out_of_range);
    EXPECT_EQ(why.field, "radius");
    EXPECT_EQ(why.detail, "radius: is outside 0 .. 50 voxels");
  }
  EXPECT_EQ(refused(R"({"do":"brush","radius":1e999})").code, Code::bad_field);
  EXPECT_EQ(refused(R"({"do":"brush","radius":"3"})").field, "radius");
}

TEST(PanelCommand, KnowsNoLayerBeyondTheSixteenth) {
  EXPECT_EQ(read<SetBrush>(R"({"do":"brush","layer":15})").layer, 15u);
  EXPECT_EQ(refused(R"({"do":"brush","layer":16})").field, "layer");
  EXPECT_EQ(refused(R"({"do":"show","layer":-1,"visible":true})").field, "layer");
  const auto show = read<ShowLayer>(R"({"do":"show","layer":2,"visible":false})");
  EXPECT_EQ(show.layer, 2u);
  EXPECT_FALSE(show.visible);
  EXPECT_EQ(refused(R"({"do":"show","layer":2})").field, "visible");
}

TEST(PanelCommand, ChangesLayersAsTheProtocolDoes) {
  const auto change =
      read<ChangeLayer>(R"({"do":"layer","layer":1,"name":"sea","color":"#AABBCC","wall":[-2,3]})");
  EXPECT_EQ(change.change.layer, 1u);
  EXPECT_EQ(change.change.name, "sea");
  EXPECT_EQ(change.change.color, "#aabbcc");
  EXPECT_EQ(change.change.wall, (std::array<double, 2>{-2, 3}));
  EXPECT_FALSE(read<ChangeLayer>(R"({"do":"layer"})").change.layer);
  EXPECT_EQ(refused(R"({"do":"layer","layer":1,"color":"red"})").field, "color");
  EXPECT_EQ(refused(R"({"do":"layer","layer":1})").field, "layer");
}

TEST(PanelCommand, MovesTheCamera) {
  EXPECT_EQ(read<MoveCamera>(R"({"do":"camera","action":"tilt_down"})").action, Action::tilt_down);
  const auto go = read<MoveCamera>(R"({"do":"camera","x":3,"y":-4,"zoom":20,"yaw":1,"tilt":0.5})");
  EXPECT_EQ(go.action, Action::go);
  EXPECT_EQ(go.place, (scene::Camera::Place{.target = {3, -4}, .zoom = 20, .yaw = 1, .tilt = 0.5}));
  EXPECT_EQ(refused(R"({"do":"camera","x":3,"y":-4,"zoom":0})").field, "zoom");
  EXPECT_EQ(refused(R"({"do":"camera","x":3,"zoom":1})").field, "y");
  EXPECT_EQ(refused(R"({"do":"camera","x":3,"y":4,"zoom":1,"tilt":1.4})").field, "tilt");
  EXPECT_EQ(refused(R"({"do":"camera","action":"dance"})").field, "action");
}

TEST(PanelCommand, SaysUpToFiveHundredCharacters) {
  const auto chat = [](const std::string& text) {
    return R"({"do":"chat","text":")" + text + "\"}";
  };
  EXPECT_EQ(read<Say>(chat("Grüße")).text, "Grüße");
  EXPECT_EQ(read<Say>(chat(std::string(500, 'a'))).text.size(), 500u);
  for (const std::string& text : {std::string(501, 'a'), std::string()}) {
    const auto why = refused(chat(text));
    EXPECT_EQ(why.field, "text");
    EXPECT_NE(why.detail.find("1 .. 500"), std::string::npos) << why.detail;
  }
  EXPECT_EQ(refused(chat("a\\u0007")).field, "text");
}

TEST(PanelCommand, NamesPeopleAndMaps) {
  const auto person = read<BePerson>(R"({"do":"person","name":"Jö","color":"#0000ff"})");
  EXPECT_EQ(person.name, "Jö");
  EXPECT_EQ(person.color, "#0000ff");
  EXPECT_EQ(refused(R"({"do":"person","name":"","color":"#0000ff"})").field, "name");
  EXPECT_EQ(refused(R"({"do":"person","name":")" + std::string(65, 'a') + R"(","color":"#0000ff"})")
                .field,
            "name");
  EXPECT_EQ(read<OpenMap>(R"({"do":"join","map":"my-map_2"})").map, "my-map_2");
  EXPECT_EQ(refused(R"({"do":"join","map":"Ä"})").code, Code::bad_name);
  EXPECT_EQ(read<Follow>(R"({"do":"follow","session":"00000000000000a1"})").session,
            "00000000000000a1");
  EXPECT_FALSE(read<Follow>(R"({"do":"follow"})").session);
  EXPECT_EQ(refused(R"({"do":"follow","session":"ann"})").field, "session");
  read<StampHere>(R"({"do":"stamp"})");
  read<RetryNow>(R"({"do":"retry"})");
}

TEST(PanelCommand, RefusesWhatIsNoCommand) {
  EXPECT_EQ(refused("{").code, Code::bad_json);
  EXPECT_EQ(refused("[]").code, Code::bad_message);
  EXPECT_EQ(refused("{}").field, "do");
  EXPECT_EQ(refused(R"({"do":"fly"})").code, Code::bad_message);
  EXPECT_EQ(refused(R"({"do":7})").field, "do");
  EXPECT_EQ(refused(R"({"do":")" + std::string(70'000, 'x') + "\"}").code, Code::too_large);
}

}  // namespace
}  // namespace earthwork::viewer
