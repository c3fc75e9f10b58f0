// Chat in a session: when one may talk, how fast, and what one is told on coming in.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "server/net/conversation.hpp"
#include "tests/net/speaker.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;
using protocol::ChatLines;
using protocol::Code;

std::string chat(const std::string& text, int id = 0) {
  return R"({"type":"chat","text":")" + text + '"' +
         (id == 0 ? "" : ",\"id\":" + std::to_string(id)) + "}";
}

struct ChatTest : testing::Test {
  ChatTest() {
    EXPECT_TRUE(room::create_map(atlas, "m", {}));
    EXPECT_TRUE(room::create_map(atlas, "other", {}));
  }
  void join(Speaker& speaker) {
    speaker.one<protocol::Welcome>(kHello);
    speaker.say(kJoin);
  }
  /// Time passes, and all is heard that comes of it.
  static std::vector<std::string> later(Speaker& speaker, std::chrono::milliseconds time) {
    speaker.context.advance(time);
    return lines(speaker.hear());
  }
  static std::vector<std::string> lines(const std::vector<protocol::ServerMessage>& heard) {
    std::vector<std::string> texts;
    for (const auto& message : heard)
      if (const auto* chat = std::get_if<ChatLines>(&message))
        for (const auto& line : chat->lines) texts.push_back(line.text);
    return texts;
  }

  room::ManualContext context;
  room::Atlas atlas{{.make_strand = [this] { return context.make_strand(); }}};
  Speaker ann{atlas, context}, bob{atlas, context};
};

TEST_F(ChatTest, IsForWhoHasJoined) {
  ann.refused(chat("hi", 1), Code::bad_state, 1);
  ann.one<protocol::Welcome>(kHello);
  ann.refused(chat("hi", 1), Code::bad_state, 1);
  ann.one<protocol::Joined>(kJoin);
  later(ann, 1s);
  EXPECT_EQ(lines(ann.say(chat("hi"))), std::vector<std::string>{"hi"});
  ann.say(R"({"type":"leave"})");
  ann.refused(chat("hi", 2), Code::bad_state, 2);
}

TEST_F(ChatTest, IsDoneWhenItAsksForItAndToldToAll) {
  join(ann), join(bob);
  later(ann, 1s), later(bob, 1s);
  const auto heard = ann.say(chat("hello", 5));
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(std::get<protocol::Done>(heard[0]).id, 5);
  const auto told = std::get<ChatLines>(heard[1]);
  ASSERT_EQ(told.lines.size(), 1u);
  EXPECT_EQ(told.lines[0].n, 1u);
  EXPECT_EQ(told.lines[0].name, "ann");
  EXPECT_EQ(told.lines[0].time_ms, context.now().count());
  const auto others = bob.hear();
  ASSERT_EQ(others.size(), 1u);
  EXPECT_EQ(std::get<ChatLines>(others[0]), told);
}

TEST_F(ChatTest, WhatIsTooLongOrEmptyIsRefusedAndNotCounted) {
  join(ann);
  for (int i = 0; i < 20; ++i) {
    ann.refused(chat(std::string(501, 'x'), 7), Code::out_of_range, 7);
    ann.refused(chat("", 8), Code::out_of_range, 8);
    ann.refused(chat("a\\u0000b", 9), Code::bad_field, 9);
  }
  later(ann, 1s);
  EXPECT_EQ(lines(ann.say(chat(std::string(500, 'x')))).size(), 1u);
}

TEST_F(ChatTest, EightLinesInTenSecondsAndNotOneMore) {
  join(ann);
  later(ann, 1s);
  for (int i = 0; i < 8; ++i) {
    ann.say(chat("hello", 10 + i));
    context.advance(500ms);
  }
  const auto rejected = ann.one<protocol::Rejected>(chat("hello", 20));
  EXPECT_EQ(rejected.id, 20);
  EXPECT_EQ(rejected.failure.code, Code::too_fast);
  EXPECT_EQ(rejected.failure.field, "text");
  EXPECT_EQ(rejected.failure.detail,
            "text: a session may say 8 lines in 10 s; say it again in 6000 ms");
  ann.refused(chat("hello"), Code::too_fast, {});
  context.advance(5'999ms);
  ann.refused(chat("hello", 21), Code::too_fast, 21);
  context.advance(1ms);
  EXPECT_EQ(std::get<protocol::Done>(ann.say(chat("hello", 22)).at(0)).id, 22);
  EXPECT_EQ(atlas.meters().rejected[static_cast<std::size_t>(Code::too_fast)], 3u);
  EXPECT_EQ(atlas.meters().chat_lines, 9u);
}

TEST_F(ChatTest, TheRateIsThatOfASessionInAllItsMaps) {
  join(ann), join(bob);
  for (int i = 0; i < 8; ++i) ann.say(chat("hello"));
  ann.say(R"({"type":"leave"})");
  ann.say(R"({"type":"join","map":"other"})");
  ann.refused(chat("hello", 3), Code::too_fast, 3);
  EXPECT_EQ(std::get<protocol::Done>(bob.say(chat("hello", 4)).at(0)).id, 4);
}

TEST_F(ChatTest, WhoJoinsIsToldBeforeTheMeshes) {
  join(ann);
  ann.say(R"({"type":"edit","id":4,"stencil":"circle","fill":true,"x":5,"y":5,"radius":3})");
  ann.say(chat("one")), ann.say(chat("two"));
  bob.one<protocol::Welcome>(kHello);
  bob.conversation->receive(kJoin);
  context.run();  // the view is sent as soon as it may be, before anything was read
  bob.conversation->receive(R"({"type":"view","n":1,"all":true,"id":3})");
  context.run();
  std::vector<std::string> order;
  for (;;) {
    const auto messages = bob.take();
    if (messages.empty()) break;
    for (const WireMessage& message : messages)
      order.push_back(
          message.kind == Kind::binary ? "mesh" : message.bytes.substr(0, message.bytes.find(',')));
    bob.conversation->written();
    context.run();
  }
  ASSERT_GE(order.size(), 4u);
  EXPECT_EQ(order[0], R"({"type":"joined")");
  EXPECT_EQ(order[1], R"({"type":"done")");
  EXPECT_EQ(order[2], R"({"type":"chat")");
  EXPECT_EQ(order[3], "mesh");
}

TEST_F(ChatTest, WhatWasSaidStaysForWhoComesAndIsOfItsMapAlone) {
  join(ann);
  for (int i = 0; i < 104; ++i) {
    ann.say(chat(std::to_string(i)));
    context.advance(1500ms);
  }
  ann.say(R"({"type":"leave"})");
  bob.one<protocol::Welcome>(kHello);
  EXPECT_EQ(lines(bob.say(R"({"type":"join","map":"other"})")), std::vector<std::string>{});
  bob.say(R"({"type":"leave"})");
  const auto heard = lines(bob.say(kJoin));
  ASSERT_EQ(heard.size(), 100u);
  EXPECT_EQ(heard.front(), "4");
  EXPECT_EQ(heard.back(), "103");
}

}  // namespace
}  // namespace earthwork::net
