// What people see of each other, as it is read from messages of both sides.
#include <gtest/gtest.h>

#include <string>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {
namespace {

/// The message as it is written again, or "code: detail" of its refusal.
template <class Message>
std::string echoed(const Result<Message>& message) {
  if (message) return write(*message);
  EXPECT_EQ(message.error().detail.rfind(message.error().field, 0), 0u) << "names its field";
  return std::string(name(message.error().code)) + ": " + message.error().detail;
}

std::string cursor(const std::string& fields) {
  return echoed(parse_client_message(R"({"type":"cursor",)" + fields + "}"));
}
std::string brush(const std::string& fields) {
  return cursor(R"("x":0,"y":0,"brush":{)" + fields + "}");
}
std::string presence(const std::string& fields) {
  return echoed(parse_server_message(R"({"type":"presence")" + fields + "}"));
}

TEST(Cursor, PointsSomewhereOrIsHidden) {
  EXPECT_EQ(cursor(R"("x":1,"y":-2.5)"), R"({"type":"cursor","x":1.0,"y":-2.5})");
  EXPECT_EQ(cursor(R"("hidden":true)"), R"({"type":"cursor","hidden":true})");
  EXPECT_EQ(cursor(R"("hidden":false,"x":1,"y":2)"), R"({"type":"cursor","x":1.0,"y":2.0})");
  EXPECT_EQ(cursor(R"("hidden":null,"x":1,"y":2)"), R"({"type":"cursor","x":1.0,"y":2.0})");
}

TEST(Cursor, SaysWhatIsWrongWithItsPlace) {
  EXPECT_EQ(cursor(R"("id":1)"), "bad_field: x: is missing");
  EXPECT_EQ(cursor(R"("x":1)"), "bad_field: y: is missing");
  EXPECT_EQ(cursor(R"("x":"1","y":0)"), "bad_field: x: is not a number");
  EXPECT_EQ(cursor(R"("x":0,"y":[1])"), "bad_field: y: is not a number");
  EXPECT_EQ(cursor(R"("x":0,"y":-1e999)"),
            "bad_field: y: the number does not fit into a 64-bit float");
  EXPECT_EQ(cursor(R"("hidden":1,"x":1,"y":2)"), "bad_field: hidden: is not true or false");
  EXPECT_EQ(cursor(R"("hidden":true,"y":2)"), "bad_field: hidden: does not go with x and y");
  EXPECT_EQ(cursor(R"("hidden":true,"id":0)"),
            "out_of_range: id: is outside 1 .. 9007199254740991");
}

TEST(Cursor, HoldsABrush) {
  EXPECT_EQ(
      brush(R"("stencil":"square","radius":0,"fill":false,"layer":15)"),
      R"({"type":"cursor","x":0.0,"y":0.0,"brush":{"stencil":"square","radius":0.0,"fill":false,"layer":15}})");
  EXPECT_EQ(
      brush(R"("layer":0,"fill":true,"radius":1e300,"stencil":"circle","shine":7)"),
      R"({"type":"cursor","x":0.0,"y":0.0,"brush":{"stencil":"circle","radius":1e+300,"fill":true}})");
  EXPECT_EQ(
      cursor(R"("hidden":true,"brush":{"stencil":"circle","radius":1,"fill":true},"id":9)"),
      R"({"type":"cursor","hidden":true,"brush":{"stencil":"circle","radius":1.0,"fill":true},"id":9})");
}

TEST(Cursor, SaysWhatIsSeen) {
  const std::string both = R"({"type":"cursor","x":0.0,"y":0.0,"view":[-8.0,0.5,8.0,16.0]})";
  EXPECT_EQ(cursor(R"("view":[-8,0.5,8,16],"x":0,"y":0)"), both);
  const std::string hidden = R"({"type":"cursor","hidden":true,"view":[0.0,0.0,0.0,0.0]})";
  EXPECT_EQ(cursor(R"("hidden":true,"view":[0,0,0,0])"), hidden);
  EXPECT_EQ(
      presence(R"(,"cursors":[{"session":"0123456789abcdef","hidden":true,"view":[0,0,1,1]}])"),
      R"({"type":"presence","cursors":[{"session":"0123456789abcdef","hidden":true,"view":[0.0,0.0,1.0,1.0]}]})");
}

TEST(Cursor, SaysWhatIsWrongWithItsView) {
  EXPECT_EQ(cursor(R"("hidden":true,"view":[0,0,1])"), "bad_field: view: 3 elements are not 4");
  EXPECT_EQ(cursor(R"("hidden":true,"view":[1,0,0,1])"),
            "out_of_range: view: [x0, y0, x1, y1] needs x0 <= x1 and y0 <= y1");
  EXPECT_EQ(cursor(R"("hidden":true,"view":[0,1,1,0])"),
            "out_of_range: view: [x0, y0, x1, y1] needs x0 <= x1 and y0 <= y1");
  EXPECT_EQ(cursor(R"("hidden":true,"view":true)"), "bad_field: view: is not an array");
}

TEST(Cursor, SeesAsFarAsCoordinatesGoAndNoFurther) {
  const MapSettings half{.chunks = {}, .voxel_size = 0.5};
  EXPECT_TRUE(check_seen({-500'000, -500'000, 500'000, 500'000}, half));
  const auto far = check_seen({-500'000, -500'000, 500'000, 500'000.5}, half);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error(),
            (Failure{Code::out_of_range,
                     "view: 1000001 voxels from 0 is beyond the limit of 1000000", "view"}));
  EXPECT_FALSE(check_seen({-500'000.5, 0, 0, 0}, half));
  EXPECT_FALSE(check_seen({-1e308, -1e308, 1e308, 1e308}, half));
}

TEST(Cursor, SaysWhatIsWrongWithItsBrush) {
  EXPECT_EQ(cursor(R"("x":0,"y":0,"brush":"round")"), "bad_field: brush: not a JSON object");
  EXPECT_EQ(brush(""), "bad_field: brush.stencil: is missing");
  EXPECT_EQ(brush(R"("stencil":"star")"),
            "bad_field: brush.stencil: is not \"square\" or \"circle\"");
  EXPECT_EQ(brush(R"("stencil":"circle")"), "bad_field: brush.radius: is missing");
  EXPECT_EQ(brush(R"("stencil":"circle","radius":-1e-9)"),
            "out_of_range: brush.radius: is below 0");
  EXPECT_EQ(brush(R"("stencil":"circle","radius":1)"), "bad_field: brush.fill: is missing");
  for (const char* layer : {"-1", "16"})
    EXPECT_EQ(brush(R"("stencil":"circle","radius":1,"fill":true,"layer":)" + std::string(layer)),
              "out_of_range: brush.layer: is outside 0 .. 15");
}

TEST(Presence, IsWrittenWithoutEmptyLists) {
  EXPECT_EQ(presence(""), R"({"type":"presence"})");
  EXPECT_EQ(presence(R"(,"all":false,"users":[],"left":[],"cursors":[])"),
            R"({"type":"presence"})");
  EXPECT_EQ(presence(R"(,"all":true)"), R"({"type":"presence","all":true})");
  EXPECT_EQ(presence(R"(,"left":["0123456789abcdef","fedcba9876543210"])"),
            R"({"type":"presence","left":["0123456789abcdef","fedcba9876543210"]})");
}

TEST(Presence, SaysWhoCame) {
  const std::string user =
      R"({"session":"0123456789abcdef","name":"Jö","color":"#112233","author":"fedcba9876543210"})";
  EXPECT_EQ(presence(R"(,"users":[)" + user + "," + user + "]"),
            R"({"type":"presence","users":[)" + user + "," + user + "]}");
  EXPECT_EQ(presence(R"(,"users":[)" + user + ",7]"), "bad_field: users[1]: not a JSON object");
  EXPECT_EQ(presence(R"(,"users":[{"session":"0123456789ABCDEF"}])"),
            "bad_field: users[0].session: is not 16 hex digits in lower case");
  EXPECT_EQ(presence(R"(,"users":[{"session":"0123456789abcdef","name":"a","color":"#112233"}])"),
            "bad_field: users[0].author: is missing");
  EXPECT_EQ(presence(R"(,"users":{})"), "bad_field: users: is not an array");
}

TEST(Presence, SaysWhoLeft) {
  EXPECT_EQ(presence(R"(,"left":"0123456789abcdef")"), "bad_field: left: is not an array");
  for (const char* session : {"\"0123456789abcde\"", "\"0123456789abcdef0\"",
                              "\"0123456789abcdeF\"", "\"0123456789abcdeg\"", "7", "null", "[]"})
    EXPECT_EQ(presence(R"(,"left":["0123456789abcdef",)" + std::string(session) + "]"),
              "bad_field: left: element 1 is not 16 hex digits in lower case");
}

TEST(Presence, SaysWhereOthersPoint) {
  const std::string cursors =
      R"([{"session":"0123456789abcdef","x":1.5,"y":-2.0,"brush":{"stencil":"circle","radius":3.0,"fill":true,"layer":1}},)"
      R"({"session":"fedcba9876543210","hidden":true}])";
  EXPECT_EQ(presence(R"(,"cursors":)" + cursors),
            R"({"type":"presence","cursors":)" + cursors + "}");
  EXPECT_EQ(presence(R"(,"cursors":[{"x":0,"y":0}])"), "bad_field: cursors[0].session: is missing");
  EXPECT_EQ(presence(R"(,"cursors":[{"session":"0123456789abcdef"}])"),
            "bad_field: cursors[0].x: is missing");
  EXPECT_EQ(presence(R"(,"cursors":[{"session":"0123456789abcdef","hidden":true,"brush":{}}])"),
            "bad_field: cursors[0].brush.stencil: is missing");
}

TEST(Presence, ListsAsManyAsAMessageHolds) {
  std::string left;
  for (int i = 0; i < 50'000; ++i) left += ",\"0123456789abcdef\"";
  const auto read = parse_server_message(R"({"type":"presence","left":[)" + left.substr(1) + "]}");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(std::get<Presence>(*read).left.size(), 50'000u);
  // Short enough for a message, and nothing that could be a list of sessions.
  std::string numbers;
  for (std::size_t i = 0; i <= kMaxServerControlBytes / 16; ++i) numbers += ",1";
  EXPECT_EQ(presence(R"(,"left":[)" + numbers.substr(1) + "]"),
            "out_of_range: left: 65537 elements are outside 0 .. 65536");
}

}  // namespace
}  // namespace earthwork::protocol
