/// What was said on the map: the last lines of it.
#pragma once

#include <string>
#include <vector>

#include "client/viewer/panel_state.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

class ChatLog {
 public:
  /// A connection has joined: the lines that come first are those the server keeps, and take the
  /// place of what is here.
  void join() { fresh_ = true; }
  void clear() { lines_.clear(); }
  /// Keeps the last protocol::kKeptChatLines.
  void take(const protocol::ChatLines& said);
  /// `session`: one's own.
  [[nodiscard]] ChatPart part(std::string session) const;

 private:
  std::vector<protocol::ChatLine> lines_;
  bool fresh_ = true;
};

}  // namespace earthwork::viewer
