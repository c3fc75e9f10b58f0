/// A client at a conversation without a socket: what it says, and what it is answered.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/messages.hpp"
#include "server/net/conversation.hpp"
#include "server/room/manual_context.hpp"
#include "tests/net/wire_messages.hpp"

namespace earthwork::net {

struct Speaker {
  Speaker(room::Atlas& atlas, room::ManualContext& manual)
      : context(manual),
        conversation(
            std::make_shared<Conversation>(atlas, context.make_strand(), [this] { ++wakes; })) {}
  ~Speaker() { conversation->abandon(), context.run(); }

  /// Sends a message, and gives back all text that comes of it; binary is counted.
  std::vector<protocol::ServerMessage> say(const std::string& text) {
    conversation->receive(text);
    return hear();
  }
  std::vector<protocol::ServerMessage> hear() {
    std::vector<protocol::ServerMessage> heard;
    for (context.run();; context.run()) {
      const auto messages = take();
      if (messages.empty()) return heard;
      for (const WireMessage& message : messages) {
        if (message.kind == Kind::binary)
          ++binary;
        else
          heard.push_back(protocol::parse_server_message(message.bytes).value());
      }
      conversation->written();
    }
  }
  /// What is to be written next, which is not written yet.
  std::vector<WireMessage> take() {
    std::string out;
    conversation->take_output(out, 1);
    return wire_messages(out);
  }
  /// The one answer, which has to be a T.
  template <class T>
  T one(const std::string& text) {
    const auto heard = say(text);
    EXPECT_EQ(heard.size(), 1u) << text;
    return std::get<T>(heard.at(0));
  }
  void refused(const std::string& text, protocol::Code code,
               std::optional<protocol::MessageId> id) {
    const auto rejected = one<protocol::Rejected>(text);
    EXPECT_EQ(rejected.failure.code, code) << text;
    EXPECT_EQ(rejected.id, id) << text;
  }

  room::ManualContext& context;
  std::shared_ptr<Conversation> conversation;
  int wakes = 0, binary = 0;
};

inline const std::string kHello = R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})";
inline const std::string kJoin = R"({"type":"join","map":"m","id":2})";

}  // namespace earthwork::net
