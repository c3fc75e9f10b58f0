// A map that a test serves through a FakeServer: it keeps to the protocol's rule of ids, and breaks
// connections where it is told to.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "tests/link/fake_server.hpp"

namespace earthwork::link {

/// Where a connection breaks: after so many messages that are no hello and no join.
struct Break {
  enum class How { before_the_answer, after_the_answer, with_bye };
  int after_messages = 0;
  How how = How::before_the_answer;
};

/// Used on the server's thread alone until the server is gone.
struct FakeMap {
  std::string epoch = "00000000000000aa";
  std::map<protocol::MessageId, std::uint64_t> applied;  ///< The seq of each.
  std::uint64_t seq = 3;
  bool gone = false;  ///< No join finds it.
  bool answers_twice = false;
  std::uint32_t retry_after_ms = 0;  ///< Of a bye.
  /// How the connections break, the first one first; those after them do not.
  std::vector<Break> breaks;
  /// Called after each connection, with their count so far.
  std::function<void(FakeMap&, std::size_t)> after;

  std::vector<std::vector<std::string>> heard;  ///< By connection.

  /// One connection, from hello to end.
  void play(Peer& peer);

 private:
  bool greet(Peer& peer);
  /// Without an asker it is applied and not answered.
  void take(const std::string& text, Peer* asker);
};

}  // namespace earthwork::link
