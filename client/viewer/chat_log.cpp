#include "client/viewer/chat_log.hpp"

#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::viewer {

void ChatLog::take(const protocol::ChatLines& said) {
  if (said.lines.empty()) return;
  if (std::exchange(fresh_, false)) lines_.clear();
  lines_.insert(lines_.end(), said.lines.begin(), said.lines.end());
  if (lines_.size() <= protocol::kKeptChatLines) return;
  const auto surplus = static_cast<std::ptrdiff_t>(lines_.size() - protocol::kKeptChatLines);
  lines_.erase(lines_.begin(), lines_.begin() + surplus);
}

ChatPart ChatLog::part(std::string session) const {
  return {.lines = lines_, .session = std::move(session)};
}

}  // namespace earthwork::viewer
