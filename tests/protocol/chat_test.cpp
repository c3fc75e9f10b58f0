// Chat as it stands in messages: what may be said, and what a reader is told of it.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>
#include <variant>
#include <vector>

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
std::string chat(const std::string& fields) {
  return echoed(parse_client_message(R"({"type":"chat")" + fields + "}"));
}
std::string said(const std::string& text) { return chat(R"(,"text":")" + text + '"'); }

const std::string kSession = R"("session":"0123456789abcdef")";
const std::string kWho = kSession + R"(,"name":"ann","color":"#102030")";
std::string line(const std::string& fields) { return R"({"n":1,"time":2,)" + kWho + fields + "}"; }
std::string lines(const std::string& list) {
  return echoed(parse_server_message(R"({"type":"chat","lines":[)" + list + "]}"));
}

std::string repeated(const std::string& one, std::size_t times) {
  std::string out;
  while (times-- > 0) out += one;
  return out;
}

TEST(Chat, IsWrittenAsItIsRead) {
  for (const char* text : {R"({"type":"chat","text":"hello, Jö \"quoted\" \\ 🌍"})",
                           R"({"type":"chat","text":" ","id":7})"})
    EXPECT_EQ(echoed(parse_client_message(text)), text);
}

TEST(Chat, HasFiveHundredCharactersAndNotOneMore) {
  EXPECT_EQ(said("x"), R"({"type":"chat","text":"x"})");
  const std::string most = repeated("\xF0\x9F\x8C\x8D", 500);
  EXPECT_EQ(said(most), R"({"type":"chat","text":")" + most + "\"}");
  EXPECT_EQ(said(most + "x"), "out_of_range: text: has 501 characters, outside 1 .. 500");
  EXPECT_EQ(said(""), "out_of_range: text: has 0 characters, outside 1 .. 500");
}

TEST(Chat, SaysWhatIsWrong) {
  EXPECT_EQ(chat(""), "bad_field: text: is missing");
  EXPECT_EQ(chat(R"(,"text":7)"), "bad_field: text: is not a string");
  EXPECT_EQ(said("a\\u0007b"), "bad_field: text: holds a control character");
  EXPECT_EQ(said("a\\nb"), "bad_field: text: holds a control character");
  EXPECT_EQ(said("a\\u0085b"), "bad_field: text: holds a control character");
  EXPECT_EQ(chat(R"(,"text":"a","id":0)"), "out_of_range: id: is outside 1 .. 9007199254740991");
}

TEST(ChatLines, AreWrittenAsTheyAreRead) {
  const std::string text =
      R"({"type":"chat","lines":[{"n":1,"time":1700000000123,"session":"0123456789abcdef","name":"Jö","color":"#aabbcc","text":"hello"},{"n":2,"time":-5,"session":"00000000000000b0","name":"bob","color":"#0000bb","text":"hi"}]})";
  EXPECT_EQ(echoed(parse_server_message(text)), text);
}

TEST(ChatLines, AreOneToAHundred) {
  const std::string one = line(R"(,"text":"x")");
  EXPECT_EQ(lines(""), "out_of_range: lines: 0 elements are outside 1 .. 100");
  EXPECT_EQ(lines(one + repeated("," + one, 99)),
            R"({"type":"chat","lines":[)" + one + repeated("," + one, 99) + "]}");
  EXPECT_EQ(lines(one + repeated("," + one, 100)),
            "out_of_range: lines: 101 elements are outside 1 .. 100");
}

TEST(ChatLines, SayWhichOfThemIsWrong) {
  const std::string good = line(R"(,"text":"x")");
  EXPECT_EQ(lines(good + ",7"), "bad_field: lines[1]: not a JSON object");
  EXPECT_EQ(lines(good + "," + line("")), "bad_field: lines[1].text: is missing");
  EXPECT_EQ(lines(R"({"n":0})"), "out_of_range: lines[0].n: is outside 1 .. 9007199254740991");
  EXPECT_EQ(lines(line(R"(,"text":")" + repeated("x", 501) + '"')),
            "out_of_range: lines[0].text: has 501 characters, outside 1 .. 500");
  EXPECT_EQ(lines(R"({"n":1,"time":2,)" + kSession + R"(,"name":"","color":"#102030","text":"x"})"),
            "out_of_range: lines[0].name: has 0 characters, outside 1 .. 64");
}

/// 1 .. `most` characters, some that JSON escapes, some of several bytes.
std::string any_words(int most) {
  std::string words;
  for (int left = *rc::gen::inRange(1, most + 1); left > 0; --left)
    words += *rc::gen::element<std::string>("a", " ", "\"", "\\", "ö", "\xF0\x9F\x8C\x8D", "}");
  return words;
}

TEST(Chat, SurvivesTheRoundTrip) {
  EXPECT_TRUE(rc::check([] {
    const ClientMessage sent = Chat{any_words(500), *rc::gen::inRange<MessageId>(1, kMaxInteger)};
    RC_ASSERT(parse_client_message(write(sent)).value() == sent);
    ChatLines told;
    for (int left = *rc::gen::inRange(1, 5); left > 0; --left)
      told.lines.push_back({.n = *rc::gen::inRange<std::uint64_t>(1, 1000),
                            .time_ms = *rc::gen::inRange<std::int64_t>(-kMaxInteger, kMaxInteger),
                            .session = "0123456789abcdef",
                            .name = any_words(64),
                            .color = "#102030",
                            .text = any_words(500)});
    RC_ASSERT(parse_server_message(write(ServerMessage(told))).value() == ServerMessage(told));
  }));
}

/// So that a map's kept lines, whatever they are, could go in one message.
TEST(ChatLines, AllThatAreKeptFitIntoAMessage) {
  const std::string longest = repeated("\xF0\x9F\x8C\x8D", 500);
  ChatLines all;
  for (std::size_t i = 0; i < kKeptChatLines; ++i)
    all.lines.push_back({.n = kMaxInteger,
                         .time_ms = -kMaxInteger,
                         .session = "0123456789abcdef",
                         .name = repeated("\xF0\x9F\x8C\x8D", 64),
                         .color = "#102030",
                         .text = longest});
  EXPECT_LT(write(ServerMessage(all)).size(), kMaxServerControlBytes);
}

}  // namespace
}  // namespace earthwork::protocol
