#include "protocol/script.hpp"

#include <gtest/gtest.h>

#include <string>

namespace earthwork::protocol {
namespace {

constexpr const char* kEdit =
    R"({"stencil":"square","fill":true,"x":1,"y":2,"radius":3,"note":"ignored"})";

std::string refusal(std::string_view text) {
  const auto script = read_script(text);
  if (script) return "good";
  return std::string(name(script.error().code)) + ": " + script.error().detail;
}

TEST(ScriptLine, IsSettingsAnEditOrAWait) {
  EXPECT_EQ(std::get<MapSettings>(*read_script_line(R"({"map":{"chunk_resolution":8}})"))
                .chunk_resolution,
            8);
  EXPECT_EQ(std::get<Edit>(*read_script_line(kEdit)).radius, 3);
  EXPECT_EQ(std::get<Wait>(*read_script_line(R"({"wait_ms":250})")).ms, 250);
}

TEST(ScriptLine, IsAChangeOfLayersWhenItsKindSaysSo) {
  const auto line = read_script_line(R"({"kind":"layer","layer":1,"name":"roof","seq":7})");
  ASSERT_TRUE(line) << line.error().detail;
  EXPECT_EQ(std::get<LayerChange>(*line),
            (LayerChange{.layer = 1, .name = "roof", .color = {}, .wall = {}}));
  EXPECT_EQ(std::get<LayerChange>(*read_script_line(R"({"kind":"layer"})")), LayerChange{});
  EXPECT_EQ(read_script_line(R"({"kind":"layer","layer":1})").error().field, "layer");
  EXPECT_EQ(std::get<Edit>(*read_script_line(std::string(R"({"kind":"edit",)") + (kEdit + 1))),
            std::get<Edit>(*read_script_line(kEdit)));
  EXPECT_EQ(read_script_line(R"({"kind":"undo"})").error().code, Code::not_supported);
}

TEST(ScriptLine, BoundsAWait) {
  EXPECT_TRUE(read_script_line(R"({"wait_ms":3600000})"));
  EXPECT_EQ(read_script_line(R"({"wait_ms":3600001})").error().detail,
            "wait_ms: is outside 0 .. 3600000");
  EXPECT_EQ(read_script_line(R"({"wait_ms":1.5})").error().code, Code::bad_field);
}

TEST(ScriptLine, NamesWhatItIsNot) {
  for (const char* line : {R"({"fill":true})", R"({"x":1,"y":2,"radius":3})", R"({"path":[[1,2]]})",
                           R"({"layer":0,"note":"no stencil"})", R"({"stroke":1})"})
    EXPECT_EQ(read_script_line(line).error().detail,
              "not a line with map, stencil, wait_ms or kind");
  EXPECT_EQ(read_script_line("7").error().code, Code::bad_message);
  EXPECT_EQ(read_script_line(R"({"generate":"rings"})").error().code, Code::not_supported);
}

TEST(ScriptLine, IsANoteWhenItHasUnknownKeysAlone) {
  for (const char* line : {R"({"note":"hi"})", R"({"type":"edit","author":[1]})", "{}"})
    EXPECT_TRUE(std::holds_alternative<Note>(read_script_line(line).value())) << line;
}

TEST(Script, SkipsNotesLikeBlankLines) {
  const std::string note = "{\"note\":\"hi\"}\n";
  const auto script = read_script(note + "{\"map\":{\"chunk_resolution\":8}}\n" + note + kEdit +
                                  "\n" + note + "{\"wait_ms\":5}");
  ASSERT_TRUE(script) << script.error().detail;
  EXPECT_EQ(script->settings->chunk_resolution, 8);
  ASSERT_EQ(script->steps.size(), 2u);
  EXPECT_EQ(refusal(note + "{\"fill\":true}"),
            "bad_message: line 2: not a line with map, stencil, wait_ms or kind");
}

TEST(Script, IsReadLineByLine) {
  const std::string text = std::string("\n{\"map\":{\"chunks\":[0,0,2,2],\"wall\":[-1,0]}}\r\n") +
                           kEdit + "\n  \t\r\n{\"wait_ms\":5}\n" + kEdit +
                           "\n{\"kind\":\"layer\",\"name\":\"roof\"}";
  const auto script = read_script(text);
  ASSERT_TRUE(script);
  ASSERT_TRUE(script->settings);
  EXPECT_EQ(script->settings->chunks, (std::array<std::int32_t, 4>{0, 0, 2, 2}));
  ASSERT_EQ(script->steps.size(), 4u);
  EXPECT_EQ(std::get<Edit>(script->steps[0]).path, (std::vector<MapPoint>{{1, 2}}));
  EXPECT_EQ(std::get<Wait>(script->steps[1]).ms, 5);
  EXPECT_TRUE(std::holds_alternative<Edit>(script->steps[2]));
  EXPECT_EQ(std::get<LayerChange>(script->steps[3]).name, "roof");
}

TEST(Script, MayHaveNoSettingsAndNoSteps) {
  EXPECT_EQ(read_script(""), Script{});
  EXPECT_EQ(read_script("\n\n"), Script{});
  EXPECT_EQ(read_script(kEdit)->settings, std::nullopt);
}

TEST(Script, NamesTheLineThatIsWrong) {
  EXPECT_EQ(refusal(std::string(kEdit) + "\n\n{\"stencil\":\"star\"}\n"),
            "bad_field: line 3: stencil: is not \"square\" or \"circle\"");
  EXPECT_EQ(refusal("{\"wait_ms\":1}\n{\"map\":{}}"),
            "bad_message: line 2: map: settings stand on the first line only");
  EXPECT_EQ(refusal("{\"map\":{}}\n{\"map\":{}}"),
            "bad_message: line 2: map: settings stand on the first line only");
  EXPECT_EQ(refusal("{\"map\":{}}\nnonsense"), "bad_json: line 2: not JSON from byte 2 on");
}

TEST(Script, BoundsALine) {
  EXPECT_EQ(refusal("\n" + std::string(65537, 'x')),
            "too_large: line 2: 65537 bytes are beyond the limit of 65536");
}

}  // namespace
}  // namespace earthwork::protocol
