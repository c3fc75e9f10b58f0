#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "tests/protocol/arbitrary.hpp"

namespace earthwork::protocol {
namespace {

/// The message as it is written again, or "code: detail" of its refusal.
std::string echo(std::string_view text) {
  const auto message = parse_client_message(text);
  if (message) return write(*message);
  return std::string(name(message.error().code)) + ": " + message.error().detail;
}

TEST(ClientMessage, IsWrittenAsItIsRead) {
  for (
      const char* text : {
          R"({"type":"hello","protocol":[1,2],"name":"Jö","color":"#aabbcc","key":"00112233445566778899aabbccddeeff","id":1})",
          R"({"type":"hello","protocol":[1,1],"name":"bot"})",
          R"({"type":"join","map":"demo","seq":7,"id":2})",
          R"({"type":"join","map":"demo"})",
          R"({"type":"leave","id":3})",
          R"({"type":"leave"})",
          R"({"type":"view","n":4294967295,"rect":[-1.5,-2.0,3.0,4.0],"have":{"epoch":"0123456789abcdef","seq":9,"rect":[0.0,0.0,1.0,1.0]},"id":4})",
          R"({"type":"view","n":0,"all":true})",
          R"({"type":"edit","id":5,"stencil":"circle","fill":true,"x":1.0,"y":2.0,"radius":3.0})",
          R"({"type":"edit","id":6,"layer":2,"stencil":"square","fill":false,"path":[[0.0,0.5]],"radius":0.0,"stroke":1})",
          R"({"type":"layer","id":6,"layer":0,"name":"Jö","color":"#aabbcc","wall":[-1.0,0.5]})",
          R"({"type":"layer","id":6})",
          R"({"type":"undo","id":7})",
          R"({"type":"redo","id":8})",
          R"({"type":"cursor","x":0.25,"y":-1.0})",
          R"({"type":"cursor","x":0.25,"y":-1.0,"brush":{"stencil":"circle","radius":3.0,"fill":true,"layer":2},"id":11})",
          R"({"type":"cursor","hidden":true})",
          R"({"type":"events","from_seq":1,"id":9})",
          R"({"type":"ping","id":10})",
          R"({"type":"ping"})",
      })
    EXPECT_EQ(echo(text), text);
}

TEST(ClientMessage, IsReadInAnyOrderWithKeysUnknown) {
  EXPECT_EQ(echo(R"({"shine":[1],"id":9007199254740991,"type":"ping"})"),
            R"({"type":"ping","id":9007199254740991})");
  EXPECT_EQ(echo(R"({"rect":[0,0,1,1],"all":false,"n":1,"have":null,"type":"view"})"),
            R"({"type":"view","n":1,"rect":[0.0,0.0,1.0,1.0]})");
}

TEST(ClientMessage, RefusesWhatIsNoMessage) {
  EXPECT_EQ(echo("[]"), "bad_message: not a JSON object");
  EXPECT_EQ(echo("{}"), "bad_field: type: is missing");
  EXPECT_EQ(echo(R"({"type":7})"), "bad_field: type: is not a string");
  EXPECT_EQ(echo(R"({"type":"applied"})"), "bad_message: type: is no message of a client");
  EXPECT_EQ(echo("nonsense"), "bad_json: not JSON from byte 2 on");
}

TEST(ClientMessage, TakesSixtyFourKibibytesAndNotAByteMore) {
  std::string text = R"({"type":"ping","x":"")";
  text.insert(text.size() - 1, std::string(kMaxControlBytes - text.size() - 1, 'x'));
  text += '}';
  ASSERT_EQ(text.size(), 65536u);
  EXPECT_EQ(echo(text), R"({"type":"ping"})");
  EXPECT_EQ(echo(text + " "), "too_large: 65537 bytes are beyond the limit of 65536");
}

TEST(ClientMessage, BoundsItsId) {
  EXPECT_EQ(echo(R"({"type":"undo"})"), "bad_field: id: is missing");
  for (const char* id : {"0", "-1", "9007199254740992", "18446744073709551615"})
    EXPECT_EQ(echo(std::string(R"({"type":"ping","id":)") + id + "}"),
              "out_of_range: id: is outside 1 .. 9007199254740991");
  for (const char* id : {"1.0", "1e3", "\"1\"", "true", "99999999999999999999999"})
    EXPECT_EQ(echo(std::string(R"({"type":"ping","id":)") + id + "}"),
              "bad_field: id: is not an integer");
}

TEST(ClientMessage, SaysWhatIsWrongWithAHello) {
  EXPECT_EQ(echo(R"({"type":"hello","name":"a"})"), "bad_field: protocol: is missing");
  EXPECT_EQ(echo(R"({"type":"hello","name":"a","protocol":[2,1]})"),
            "out_of_range: protocol: [min, max] needs min <= max");
  EXPECT_EQ(echo(R"({"type":"hello","name":"a","protocol":[0,1]})"),
            "out_of_range: protocol: element 0 is outside 1 .. 65535");
  EXPECT_EQ(echo(R"({"type":"hello","protocol":[1,1],"name":"a\u0007"})"),
            "bad_field: name: holds a control character");
  EXPECT_EQ(echo(R"({"type":"hello","protocol":[1,1],"name":"a","color":"#12345"})"),
            "bad_field: color: is not a colour like \"#8a9a5b\"");
  EXPECT_EQ(echo(R"({"type":"hello","protocol":[1,1],"name":"a","key":"00"})"),
            "bad_field: key: is not 32 hex digits in lower case");
}

TEST(ClientMessage, SaysWhatIsWrongWithAJoinOrView) {
  EXPECT_EQ(echo(R"({"type":"join","map":"De mo"})"),
            "bad_name: map: is not 1-64 characters of a-z, 0-9, '-' and '_'");
  EXPECT_EQ(echo(R"({"type":"view","n":1})"), "bad_field: rect: is missing");
  EXPECT_EQ(echo(R"({"type":"view","n":1,"all":true,"rect":[0,0,1,1]})"),
            "bad_field: all: does not go with rect");
  EXPECT_EQ(echo(R"({"type":"view","n":4294967296,"all":true})"),
            "out_of_range: n: is outside 0 .. 4294967295");
  EXPECT_EQ(echo(R"({"type":"view","n":1,"rect":[1,0,0,1]})"),
            "out_of_range: rect: [x0, y0, x1, y1] needs x0 <= x1 and y0 <= y1");
  EXPECT_EQ(echo(R"({"type":"view","n":1,"all":true,"have":{"epoch":"x"}})"),
            "bad_field: have.epoch: is not 16 hex digits in lower case");
  EXPECT_EQ(echo(R"({"type":"view","n":1,"all":true,"have":7})"),
            "bad_field: have: not a JSON object");
}

TEST(ClientMessage, SaysWhatIsWrongWithAnEdit) {
  EXPECT_EQ(echo(R"({"type":"edit","stencil":"circle"})"), "bad_field: id: is missing");
  EXPECT_EQ(echo(R"({"type":"edit","id":1,"stencil":"circle","fill":true,"x":1,"radius":1})"),
            "bad_field: y: is missing");
  EXPECT_EQ(echo(R"({"type":"edit","id":1,"stencil":"circle","fill":true,"x":1e309,"radius":1})"),
            "bad_field: x: the number does not fit into a 64-bit float");
}

TEST(ClientMessage, BoundsWhereEventsBegin) {
  const auto events = [](const std::string& from_seq) {
    return echo(R"({"type":"events","from_seq":)" + from_seq + "}");
  };
  EXPECT_EQ(events("1"), R"({"type":"events","from_seq":1})");
  EXPECT_EQ(events("9007199254740991"), R"({"type":"events","from_seq":9007199254740991})");
  for (const char* beyond : {"0", "-1", "9007199254740992"})
    EXPECT_EQ(events(beyond), "out_of_range: from_seq: is outside 1 .. 9007199254740991");
  EXPECT_EQ(events("1.0"), "bad_field: from_seq: is not an integer");
  EXPECT_EQ(events("null"), "bad_field: from_seq: is missing");
}

TEST(View, CountsItsChunks) {
  MapSettings settings;
  View view;
  EXPECT_TRUE(check_view(view, settings)) << "all of it is no rectangle";
  view.rect = MapRect{0.5, 0.5, 128 * 32, 128 * 32};
  EXPECT_TRUE(check_view(view, settings)) << "128 x 128 chunks of 32 voxels";
  view.rect = MapRect{0.5, 0.5, 128 * 32 + 0.5, 128 * 32};
  const auto checked = check_view(view, settings);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, Code::too_large);
  EXPECT_EQ(checked.error().detail, "rect: 16512 chunks are beyond the limit of 16384");
  settings.chunks = {0, 0, 128, 128};
  EXPECT_TRUE(check_view(view, settings)) << "the map ends there";
}

RC_GTEST_PROP(ClientMessage, SurvivesTheRoundTrip, ()) {
  const ClientMessage message = *any_client_message();
  const auto read = parse_client_message(write(message));
  RC_ASSERT(read.has_value());
  RC_ASSERT(*read == message);
}

}  // namespace
}  // namespace earthwork::protocol
