// Recordings: lines that say what a map accepted, and that are a script as well.
#include "protocol/recording.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "protocol/script.hpp"
#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

constexpr const char* kEvent =
    R"({"seq":7,"time":1700000000123,"author":"00112233445566ff","id":4,"kind":"edit",)"
    R"("stencil":"circle","fill":true,"x":10.0,"y":-2.5,"radius":3.0,"hash":"8a9a5b0123456789"})";

RecordedEvent event() {
  return {.seq = 7,
          .time_ms = 1700000000123,
          .author = 0x00112233445566ff,
          .id = 4,
          .action = Edit{.fill = true, .radius = 3, .path = {{10, -2.5}}, .stroke = {}},
          .hash = 0x8a9a5b0123456789};
}

/// kEvent with the value of one of its keys replaced; without the key when `value` is empty.
std::string with(const std::string& key, const std::string& value) {
  std::string line = kEvent;
  const std::size_t start = line.find("\"" + key + "\":");
  const std::size_t end = std::min(line.find(",\"", start), line.size() - 1);
  if (!value.empty()) return line.replace(start, end - start, "\"" + key + "\":" + value);
  return line.erase(start == 1 ? 1 : start - 1, start == 1 ? end : end - start + 1);
}

std::string refusal(const std::string& line) {
  const auto read = read_recorded_event(line);
  if (read) return "good";
  return std::string(name(read.error().code)) + ": " + read.error().detail;
}

RC_GTEST_PROP(Recording, ReadsWhatItWrites, ()) {
  RecordedEvent recorded{.seq = *rc::gen::inRange<std::uint64_t>(1, 1u << 30),
                         .time_ms = *rc::gen::inRange<std::int64_t>(-(1 << 30), 1 << 30),
                         .author = *rc::gen::arbitrary<std::uint64_t>(),
                         .id = *rc::gen::inRange<std::int64_t>(1, 1 << 30),
                         .action = *any_action(),
                         .hash = *rc::gen::arbitrary<std::uint64_t>()};
  const std::string line = write(recorded);
  RC_ASSERT(read_recorded_event(line) == recorded);
  RC_ASSERT(line.find('\n') == std::string::npos);
  RC_ASSERT(write(*read_recorded_event(line)) == line);

  RecordingHead head{.settings = *any_settings(), .epoch = {}};
  if (*rc::gen::arbitrary<bool>()) head.epoch = *rc::gen::arbitrary<std::uint64_t>();
  RC_ASSERT(read_recording_head(write(head)) == head);
}

RC_GTEST_PROP(Recording, IsAScript, ()) {
  const RecordingHead head{.settings = *any_settings(), .epoch = 0xfedcba9876543210};
  RecordedEvent recorded = event();
  recorded.action = *any_action();
  const auto script = read_script(write(head) + "\n" + write(recorded) + "\n");
  RC_ASSERT(script.has_value());
  RC_ASSERT(script->settings == head.settings);
  RC_ASSERT(script->steps.size() == 1);
  if (const auto* edit = std::get_if<Edit>(&recorded.action))
    RC_ASSERT(script->steps[0] == ScriptStep(*edit));
  else
    RC_ASSERT(script->steps[0] == ScriptStep(std::get<LayerChange>(recorded.action)));
}

TEST(Recording, WritesALineAsTheSpecificationShowsIt) {
  EXPECT_EQ(write(event()), kEvent);
  EXPECT_EQ(write(RecordingHead{.settings = {}, .epoch = 0xab}),
            R"({"map":{"chunk_resolution":32,"layers":[{"color":"#8a9a5b","name":"ground",)"
            R"("wall":[-1.0,0.0]}],"max_feature_angle":135.0,"voxel_size":1.0},)"
            R"("epoch":"00000000000000ab"})");
}

TEST(RecordedEvent, MayHaveUnknownKeysAndNoKind) {
  EXPECT_EQ(read_recorded_event(with("kind", "")), event());
  EXPECT_EQ(read_recorded_event(with("kind", "\"edit\",\"note\":[1]")), event());
  EXPECT_EQ(read_recorded_event(std::string(kEvent) + "\r\n"), event());
}

TEST(RecordedEvent, MayBeAChangeOfLayers) {
  RecordedEvent recorded = event();
  recorded.action = LayerChange{.layer = {}, .name = "roof", .color = {}, .wall = {{0, 2.5}}};
  const std::string line =
      R"({"seq":7,"time":1700000000123,"author":"00112233445566ff","id":4,"kind":"layer",)"
      R"("name":"roof","wall":[0.0,2.5],"hash":"8a9a5b0123456789"})";
  EXPECT_EQ(write(recorded), line);
  EXPECT_EQ(read_recorded_event(line), recorded);
}

TEST(RecordedEvent, NamesWhatIsMissing) {
  for (const char* key :
       {"seq", "time", "author", "id", "stencil", "fill", "x", "y", "radius", "hash"}) {
    const auto read = read_recorded_event(with(key, ""));
    ASSERT_FALSE(read) << key;
    EXPECT_TRUE(read.error().detail.starts_with(std::string(key) + ": is ")) << read.error().detail;
  }
}

TEST(RecordedEvent, BoundsItsNumbers) {
  EXPECT_EQ(refusal(with("seq", "0")), "out_of_range: seq: is outside 1 .. 9007199254740991");
  EXPECT_EQ(refusal(with("seq", "9007199254740991")), "good");
  EXPECT_EQ(refusal(with("seq", "9007199254740992")),
            "out_of_range: seq: is outside 1 .. 9007199254740991");
  EXPECT_EQ(refusal(with("seq", "7.0")), "bad_field: seq: is not an integer");
  EXPECT_EQ(refusal(with("id", "0")), "out_of_range: id: is outside 1 .. 9007199254740991");
  EXPECT_EQ(refusal(with("time", "-9007199254740991")), "good");
  EXPECT_EQ(refusal(with("time", "9007199254740992")),
            "out_of_range: time: is outside -9007199254740991 .. 9007199254740991");
  EXPECT_EQ(refusal(with("radius", "-1")), "out_of_range: radius: is below 0");
  EXPECT_EQ(refusal(with("x", "1e999")),
            "bad_field: x: the number does not fit into a 64-bit float");
}

TEST(RecordedEvent, WantsHashesInHexAndKnownKinds) {
  EXPECT_EQ(refusal(with("hash", "\"8A9A5B0123456789\"")),
            "bad_field: hash: is not 16 hex digits in lower case");
  EXPECT_EQ(refusal(with("author", "\"0\"")),
            "bad_field: author: is not 16 hex digits in lower case");
  EXPECT_EQ(refusal(with("kind", "\"undo\"")), "not_supported: kind: is not known here");
  EXPECT_EQ(refusal("[]"), "bad_message: not a JSON object");
  EXPECT_EQ(refusal(std::string(65537, ' ')),
            "too_large: 65537 bytes are beyond the limit of 65536");
}

TEST(RecordedEvent, FitsIntoALineAtEveryLimit) {
  RecordedEvent longest = event();
  auto& edit = std::get<Edit>(longest.action);
  edit.is_path = true;
  edit.path.assign(1024, {-1.2345678901234567e-300, -1.2345678901234567e-300});
  edit.stroke = -9007199254740991;
  longest.seq = 9007199254740991;
  EXPECT_EQ(read_recorded_event(write(longest)), longest);
}

TEST(RecordingHead, NeedsSettingsThatCanBe) {
  EXPECT_EQ(read_recording_head("{}").error().detail, "map: is missing");
  EXPECT_EQ(read_recording_head(R"({"map":{"chunk_resolution":9}})").error().detail,
            "chunk_resolution: is not 8, 16, 32 or 64");
  EXPECT_EQ(read_recording_head(R"({"map":{},"epoch":"xyz"})").error().field, "epoch");
  EXPECT_EQ(read_recording_head(R"({"map":{},"note":1})"), RecordingHead{});
  EXPECT_EQ(read_recording_head("nonsense").error().code, Code::bad_json);
}

}  // namespace
}  // namespace earthwork::protocol
