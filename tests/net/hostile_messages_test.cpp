// Messages that no client of ours would send: each has its answer, the session goes on, and a
// painter on the same map notices nothing.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/net/hostile_server.hpp"

namespace earthwork::net {
namespace {

using nlohmann::json;

struct HostileMessagesTest : HostileTest {
  HostileMessagesTest() { enter(client, "m"); }

  /// The reply to `message`, in which # stands for the next id.
  json ask(std::string message) {
    const std::size_t at = message.find('#');
    if (at != std::string::npos) message.replace(at, 1, std::to_string(++id));
    client.text(message);
    return reply(client);
  }
  /// Is refused with `code`, and names `field` unless that is empty.
  void expect_refused(const std::string& message, const std::string& code,
                      const std::string& field = {}) {
    const json answer = ask(message);
    ASSERT_TRUE(answer.is_object()) << message;
    EXPECT_EQ(answer.at("type"), "rejected") << message;
    EXPECT_EQ(answer.value("code", ""), code) << message << answer;
    if (!field.empty()) EXPECT_EQ(answer.value("field", ""), field) << message << answer;
    EXPECT_FALSE(answer.value("message", "").empty());
  }

  SocketClient client{port};
  int id = 10;
};

TEST_F(HostileMessagesTest, BracketsUponBrackets) {
  expect_refused(std::string(3000, '['), "bad_json");
  expect_refused(std::string(60'000, '['), "bad_json");
  std::string objects;
  for (int i = 0; i < 3000; ++i) objects += "{\"a\":";
  expect_refused(objects, "bad_json");
  const json deep =
      ask(R"({"type":"ping","id":#,"note":)" + std::string(16, '[') + std::string(16, ']') + "}");
  EXPECT_EQ(deep.at("code"), "bad_json");
  EXPECT_NE(deep.at("message").get<std::string>().find("16"), std::string::npos);
  EXPECT_EQ(deep.at("id"), id);
}

TEST_F(HostileMessagesTest, WhatIsNoMessage) {
  for (const char* text : {"", " ", "null", "7", "\"hello\"", "[]", "{}", R"({"type":7})",
                           R"({"type":"nonsense"})", R"({"type":"Edit"})", R"({"Type":"ping"})"}) {
    const json answer = ask(text);
    ASSERT_TRUE(answer.is_object()) << text;
    EXPECT_EQ(answer.at("type"), "rejected") << text;
    EXPECT_FALSE(answer.contains("id"));
  }
  for (const char* text :
       {"{\"type\":\"ping\"}x", "{'type':'ping'}", "{\"type\":\"ping\",}", "\xEF\xBB\xBF", "/**/{}",
        R"({"type":"\ud800"})", R"({"type":"\udc00"})"})
    expect_refused(text, "bad_json");
  expect_refused(std::string("{\"type\":\"ping\0\"}", 16), "bad_json");
  client.binary("\x01\x02");
  EXPECT_EQ(reply(client).at("code"), "bad_message");
}

/// A message with a number in it, written as @, and what is said to -0 there.
struct NumberCase {
  const char* message;
  const char* field;
  const char* at_minus_zero;  ///< A type, or the code of a refusal.
};

const NumberCase kNumberCases[] = {
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"x":@,"y":1,"radius":1})", "x",
     "applied"},
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"x":1,"y":@,"radius":1})", "y",
     "applied"},
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"x":1,"y":1,"radius":@})", "radius",
     "applied"},
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"path":[[1,1],[@,2]],"radius":1})",
     "path", "applied"},
    {R"({"type":"edit","id":#,"stencil":"square","fill":true,"path":[[1,@]],"radius":1})", "path",
     "applied"},
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"x":1,"y":1,"radius":1,"layer":@})",
     "layer", "applied"},
    {R"({"type":"edit","id":#,"stencil":"circle","fill":true,"x":1,"y":1,"radius":1,"stroke":@})",
     "stroke", "applied"},
    {R"({"type":"view","id":#,"n":@,"rect":[0,0,8,8]})", "n", "done"},
    {R"({"type":"view","id":#,"n":1,"rect":[@,0,8,8]})", "rect", "done"},
    {R"({"type":"view","id":#,"n":1,"rect":[0,@,8,8]})", "rect", "done"},
    {R"({"type":"view","id":#,"n":1,"rect":[-8,0,@,8]})", "rect", "done"},
    {R"({"type":"view","id":#,"n":1,"rect":[0,-8,8,@]})", "rect", "done"},
    {R"({"type":"cursor","id":#,"x":@,"y":1})", "x", "done"},
    {R"({"type":"cursor","id":#,"x":1,"y":@})", "y", "done"},
    {R"({"type":"events","id":#,"from_seq":@})", "from_seq", "out_of_range"},
    {R"({"type":"ping","id":@})", "id", "out_of_range"},
};

std::string with(const NumberCase& number, const std::string& value) {
  std::string message = number.message;
  return message.replace(message.find('@'), 1, value);
}

TEST_F(HostileMessagesTest, NumbersThatJsonDoesNotHave) {
  for (const NumberCase& number : kNumberCases)
    for (const char* value : {"NaN", "nan", "Infinity", "-Infinity", "inf", "+1", ".5", "1.", "0x1",
                              "01", "1e", "--1", "1_0", "-"})
      expect_refused(with(number, value), "bad_json");
}

TEST_F(HostileMessagesTest, NumbersBeyondAllBounds) {
  const std::set<std::string> codes{"bad_field", "out_of_range", "too_large"};
  for (const NumberCase& number : kNumberCases) {
    for (const char* value : {"1e308", "1.7976931348623157e308", "1e400", "123456789e999999999"}) {
      const json answer = ask(with(number, value));
      EXPECT_EQ(answer.value("type", ""), "rejected") << number.message << value;
      EXPECT_TRUE(codes.contains(answer.value("code", ""))) << number.message << value << answer;
      EXPECT_EQ(answer.value("field", ""), number.field) << number.message << value << answer;
    }
  }
}

TEST_F(HostileMessagesTest, MinusZeroIsZero) {
  for (const NumberCase& number : kNumberCases) {
    const json answer = ask(with(number, "-0"));
    const std::string said = answer.value("code", answer.value("type", ""));
    EXPECT_EQ(said, number.at_minus_zero) << number.message << answer;
  }
}

TEST_F(HostileMessagesTest, NumbersThatAreNone) {
  for (const NumberCase& number : kNumberCases)
    for (const char* value : {"\"1\"", "true", "[]", "{}", "[1]"})
      expect_refused(with(number, value), "bad_field", number.field);
}

TEST_F(HostileMessagesTest, AViewOfEverything) {
  for (const char* rect :
       {"[-1000000,-1000000,1000000,1000000]", "[-1e308,-1e308,1e308,1e308]", "[0,0,1e9,1]"}) {
    const json answer = ask(R"({"type":"view","id":#,"n":1,"rect":)" + std::string(rect) + "}");
    EXPECT_EQ(answer.at("code"), "too_large") << answer;
    EXPECT_EQ(answer.at("field"), "rect") << answer;
    EXPECT_NE(answer.at("message").get<std::string>().find("16384"), std::string::npos) << answer;
  }
}

TEST_F(HostileMessagesTest, MapsThatAreNotThere) {
  ASSERT_EQ(ask(R"({"type":"leave","id":#})").at("type"), "done");
  expect_refused(R"({"type":"join","id":#,"map":"nope"})", "unknown_map", "map");
  for (const char* name : {"", "..", "../m", "M", "m/", "m%00", "m m", "\\u0000", "ä"})
    expect_refused(R"({"type":"join","id":#,"map":")" + std::string(name) + "\"}", "bad_name",
                   "map");
  EXPECT_EQ(ask(R"({"type":"join","id":#,"map":"m"})").at("type"), "joined");
}

}  // namespace
}  // namespace earthwork::net
