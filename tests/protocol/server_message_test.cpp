#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

std::string echo(std::string_view text) {
  const auto message = parse_server_message(text);
  if (message) return write(*message);
  return std::string(name(message.error().code)) + ": " + message.error().detail;
}

TEST(ServerMessage, IsWrittenAsItIsRead) {
  for (
      const char* text : {
          R"({"type":"joined","map":"demo","settings":{"chunk_resolution":32,"layers":[{"color":"#8a9a5b","name":"ground","wall":[-1.0,0.0]}],"max_feature_angle":135.0,"voxel_size":1.0},"epoch":"0123456789abcdef","seq":7,"users":[{"session":"fedcba9876543210","name":"Jö","color":"#112233","author":"0123456789abcdef"}],"id":2})",
          R"({"type":"applied","id":3,"seq":12})",
          R"({"type":"rejected","id":4,"code":"out_of_range","message":"radius: 600 voxels is beyond the limit of 512","field":"radius"})",
          R"({"type":"rejected","code":"bad_json","message":"not JSON from byte 1 on"})",
          R"({"type":"caught_up","n":1,"seq":12})",
          R"({"type":"done","id":5})",
          R"({"type":"presence","all":true,"users":[{"session":"fedcba9876543210","name":"Jö","color":"#112233","author":"0123456789abcdef"}],"left":["0000000000000001"],"cursors":[{"session":"fedcba9876543210","x":1.0,"y":2.0}]})",
          R"({"type":"event","seq":1,"time":1700000000123,"author":"0123456789abcdef","kind":"edit","stencil":"circle","fill":true,"x":10.0,"y":-2.5,"radius":3.0,"hash":"00000000000000ff"})",
          R"({"type":"event","seq":9007199254740991,"time":-1,"author":"0123456789abcdef","kind":"edit","layer":2,"stencil":"square","fill":false,"path":[[0.0,0.5],[1.0,0.5]],"radius":0.0,"stroke":1,"hash":"00000000000000ff"})",
          R"({"type":"event","seq":2,"time":1,"author":"0123456789abcdef","kind":"layer","layer":1,"name":"Jö","hash":"00000000000000ff"})",
          R"({"type":"event","seq":3,"time":1,"author":"0123456789abcdef","kind":"layer","wall":[0.0,2.5],"hash":"00000000000000ff"})",
          R"({"type":"settings","seq":3,"settings":{"chunk_resolution":32,"layers":[{"color":"#8a9a5b","name":"ground","wall":[-1.0,0.0]}],"max_feature_angle":135.0,"voxel_size":1.0}})",
          R"({"type":"bye","code":"bad_version","message":"no version in common"})",
          R"({"type":"bye","code":"internal","message":"later","retry_after_ms":500})",
      })
    EXPECT_EQ(echo(text), text);
}

TEST(ServerMessage, WelcomesWithEveryLimitByName) {
  const std::string text =
      write(Welcome{"0123456789abcdef", "00112233445566778899aabbccddeeff", 1, 5});
  EXPECT_EQ(text.rfind(R"({"type":"welcome","session":"0123456789abcdef",)", 0), 0u);
  const auto limits = nlohmann::json::parse(text)["limits"];
  EXPECT_EQ(limits["max_control_bytes"], 65536);
  EXPECT_EQ(limits["max_json_depth"], 16);
  EXPECT_EQ(limits["max_radius_voxels"], 512);
  EXPECT_EQ(limits["max_coordinate_voxels"], 1'000'000);
  EXPECT_EQ(limits["max_path_points"], 1024);
  EXPECT_EQ(limits["max_edit_visits"], 16'777'216);
  EXPECT_EQ(limits["max_edit_chunks"], 4096);
  EXPECT_EQ(limits["max_view_chunks"], 16384);
  EXPECT_EQ(limits["max_name_characters"], 64);
  EXPECT_EQ(limits["max_frame_bytes"], 16384);
  EXPECT_EQ(limits["max_remembered_ids"], 4096);
  const auto read = parse_server_message(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(std::get<Welcome>(*read).id, 5);
}

TEST(ServerMessage, RefusesWhatIsNone) {
  EXPECT_EQ(echo(R"({"type":"ping"})"), "bad_message: type: is no message of a server");
  EXPECT_EQ(echo(R"({"type":"applied","id":1})"), "bad_field: seq: is missing");
  EXPECT_EQ(echo(R"({"type":"applied","id":1,"seq":-1})"),
            "out_of_range: seq: is outside 0 .. 9007199254740991");
  EXPECT_EQ(echo(R"({"type":"joined","map":"a","settings":{"voxel_size":0}})"),
            "out_of_range: voxel_size: 0 is outside 1e-06 .. 1000000");
  EXPECT_EQ(echo(R"({"type":"joined","map":"a","settings":{},"epoch":"0123456789abcdef","seq":1,)"
                 R"("users":[{"session":"x"}]})"),
            "bad_field: users[0].session: is not 16 hex digits in lower case");
}

/// An event with one field set to something else, or left out when it is "null".
std::string event_with(const char* field, const char* value) {
  auto event = nlohmann::json::parse(
      R"({"type":"event","seq":1,"time":0,"author":"0123456789abcdef","kind":"edit",
          "stencil":"circle","fill":true,"x":0,"y":0,"radius":1,"hash":"00000000000000ff"})");
  event[field] = nlohmann::json::parse(value);
  return echo(event.dump());
}

TEST(ServerMessage, SaysWhatIsWrongWithAnEvent) {
  EXPECT_EQ(event_with("seq", "0"), "out_of_range: seq: is outside 1 .. 9007199254740991");
  EXPECT_EQ(event_with("time", "9007199254740992"),
            "out_of_range: time: is outside -9007199254740991 .. 9007199254740991");
  EXPECT_EQ(event_with("time", "0.5"), "bad_field: time: is not an integer");
  EXPECT_EQ(event_with("author", "\"0\""), "bad_field: author: is not 16 hex digits in lower case");
  EXPECT_EQ(event_with("hash", "null"), "bad_field: hash: is missing");
  EXPECT_EQ(event_with("hash", "255"), "bad_field: hash: is not a string");
  EXPECT_EQ(event_with("kind", "null"), "bad_field: kind: is missing");
  EXPECT_EQ(event_with("kind", "\"flood\""), "not_supported: kind: is not known here");
  EXPECT_EQ(event_with("stencil", "null"), "bad_field: stencil: is missing");
  EXPECT_EQ(event_with("layer", "16"), "out_of_range: layer: is outside 0 .. 15");
}

TEST(ServerMessage, ReadsACodeOfALaterServerAsInternal) {
  EXPECT_EQ(echo(R"({"type":"rejected","id":4,"code":"too_tired","message":"m"})"),
            R"({"type":"rejected","id":4,"code":"internal","message":"m"})");
}

TEST(ServerMessage, NeverThrowsOverABrokenDetail) {
  const std::string text = write(Rejected{1, Failure{Code::bad_name, "no \xff here", "map"}});
  EXPECT_TRUE(parse_server_message(text));
}

TEST(Code, HasANameOfItsOwn) {
  for (int i = 0; i <= static_cast<int>(Code::internal); ++i)
    EXPECT_EQ(code_named(name(static_cast<Code>(i))), static_cast<Code>(i));
  EXPECT_EQ(name(Code::bad_json), "bad_json");
  EXPECT_EQ(name(Code::id_too_old), "id_too_old");
  EXPECT_EQ(name(Code::id_out_of_order), "id_out_of_order");
  EXPECT_EQ(name(Code::not_supported), "not_supported");
  EXPECT_EQ(name(Code::internal), "internal");
}

RC_GTEST_PROP(ServerMessage, SurvivesTheRoundTrip, ()) {
  const ServerMessage message = *any_server_message();
  const auto read = parse_server_message(write(message));
  RC_ASSERT(read.has_value());
  RC_ASSERT(*read == message);
}

}  // namespace
}  // namespace earthwork::protocol
