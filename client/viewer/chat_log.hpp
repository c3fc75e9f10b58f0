/// What was said on the map: the last lines of it, and which of them are one's own.
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "client/viewer/panel_state.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

/// Sessions that one had, of which lines are known as one's own: more lines are not kept either.
inline constexpr std::size_t kKeptSessions = 100;

class ChatLog {
 public:
  /// A connection has joined as `session`: the lines that come first are those the server keeps,
  /// and take the place of what is here.
  void join(std::string session);
  /// The server has told all that it kept. True when that was not known.
  bool caught_up() { return !std::exchange(known_, true); }
  /// Another map.
  void clear();
  /// Keeps the last protocol::kKeptChatLines.
  void take(const protocol::ChatLines& said);
  [[nodiscard]] ChatPart part() const;

 private:
  std::vector<protocol::ChatLine> lines_;
  std::deque<std::string> mine_;  // sessions, of connections to other maps too
  bool fresh_ = true, known_ = false;
};

}  // namespace earthwork::viewer
