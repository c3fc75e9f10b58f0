#include "protocol/json_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {
namespace {

Code code_of(std::string_view text) {
  const auto parsed = parse_json(text, 1000);
  return parsed ? Code::internal : parsed.error().code;
}

std::string nested(int levels) {
  return std::string(static_cast<std::size_t>(levels), '[') +
         std::string(static_cast<std::size_t>(levels), ']');
}

TEST(JsonText, BuildsTheTreeThatStandsThere) {
  const auto parsed = parse_json(
      R"({"a":[1,-2,0.5,"x",null,true,{"b":[]}],"c":{},"a2":18446744073709551615})", 1000);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->dump(),
            R"({"a":[1,-2,0.5,"x",null,true,{"b":[]}],"a2":18446744073709551615,"c":{}})");
}

TEST(JsonText, AgreesWithAnOrdinaryParser) {
  for (const char* text : {"0", "[]", "{}", "\"\"", "[[],[[]],{\"a\":{\"b\":{}}}]", " [1 , 2] ",
                           "{\"a\":1,\"a\":2}", "-0.0e-3", "\"\\u00e9\\ud83c\\udf0d\""}) {
    const auto parsed = parse_json(text, 1000);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(*parsed, nlohmann::json::parse(text)) << text;
  }
}

TEST(JsonText, TakesTextUpToItsLimitAndNotAByteMore) {
  EXPECT_TRUE(parse_json("[1,2]", 5));
  const auto parsed = parse_json("[1,2]", 4);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Code::too_large);
  EXPECT_EQ(parsed.error().detail, "5 bytes are beyond the limit of 4");
}

TEST(JsonText, NestsSixteenDeepAndNotSeventeen) {
  EXPECT_TRUE(parse_json(nested(16), 1000));
  const auto parsed = parse_json(nested(17), 1000);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Code::bad_json);
  EXPECT_EQ(parsed.error().detail, "nested deeper than the limit of 16");
  EXPECT_EQ(code_of(std::string(900, '[')), Code::bad_json);
}

TEST(JsonText, RefusesWhatIsNotJson) {
  for (const char* text : {"", " ", "{", "[1,]", "{\"a\"}", "{'a':1}", "nul", "01", "NaN",
                           "Infinity", "1 2", "\"a", "[1]]", "\"\n\"", "\"\\ud800\""})
    EXPECT_EQ(code_of(text), Code::bad_json) << text;
  EXPECT_EQ(parse_json("[1,x]", 9).error().detail, "not JSON from byte 4 on");
  EXPECT_EQ(parse_json({"{}\0{{{", 6}, 9).error().detail, "not JSON from byte 3 on");
}

TEST(JsonText, RefusesBrokenUtf8) {
  for (const char* text : {"\"\xff\"", "\"\xc3\"", "\"\xc0\x80\"", "\"\xed\xa0\x80\""})
    EXPECT_EQ(code_of(text), Code::bad_json);
  EXPECT_TRUE(parse_json("\"\xc3\xa9\"", 100));
}

TEST(JsonText, NamesTheFieldOfANumberBeyondFloat64) {
  const auto parsed = parse_json(R"({"x":1,"radius":1e400})", 1000);
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, Code::bad_field);
  EXPECT_EQ(parsed.error().field, "radius");
  EXPECT_EQ(parsed.error().detail, "radius: the number does not fit into a 64-bit float");
  EXPECT_TRUE(parse_json("1e308", 100));
  EXPECT_EQ(parse_json("-1e309", 100).error().field, "");
}

TEST(SalvageId, FindsTheIdOfWhatCannotBeUnderstood) {
  EXPECT_EQ(salvage_id(R"({"type":"what","id":7})"), 7);
  EXPECT_EQ(salvage_id(R"({"id":9007199254740991,"x":1e400})"), 9007199254740991);
  EXPECT_EQ(salvage_id(R"({"a":{"id":3},"b":[{"id":4}],"id":5})"), 5);
  EXPECT_EQ(salvage_id(R"({"id":8,"x":)"), 8);
}

TEST(SalvageId, FindsNothingWhereThereIsNone) {
  for (const char* text :
       {"", "7", "[7]", R"(["id",7])", R"([{"id":7}])", R"({"id":"7"})", R"({"id":7.5})",
        R"({"id":0})", R"({"id":-7})", R"({"id":9007199254740992})", R"({"id":[7]})",
        R"({"id":{"id":7}})", R"({"id":null})", R"({"a":{"id":7}})", R"({"id":7,"id":"x"})"})
    EXPECT_EQ(salvage_id(text), std::nullopt) << text;
  EXPECT_EQ(salvage_id(R"({"id":7,"x":")" + std::string(kMaxControlBytes, 'x')), std::nullopt);
}

}  // namespace
}  // namespace earthwork::protocol
