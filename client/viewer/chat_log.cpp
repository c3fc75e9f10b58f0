#include "client/viewer/chat_log.hpp"

#include <algorithm>
#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::viewer {

void ChatLog::join(std::string session) {
  fresh_ = true;
  if (std::find(mine_.begin(), mine_.end(), session) != mine_.end()) return;
  mine_.push_back(std::move(session));
  if (mine_.size() > kKeptSessions) mine_.pop_front();
}

void ChatLog::clear() {
  lines_.clear();
  known_ = false;
}

void ChatLog::take(const protocol::ChatLines& said) {
  if (said.lines.empty()) return;
  if (std::exchange(fresh_, false)) lines_.clear();
  lines_.insert(lines_.end(), said.lines.begin(), said.lines.end());
  if (lines_.size() <= protocol::kKeptChatLines) return;
  const auto surplus = static_cast<std::ptrdiff_t>(lines_.size() - protocol::kKeptChatLines);
  lines_.erase(lines_.begin(), lines_.begin() + surplus);
}

ChatPart ChatLog::part() const {
  ChatPart part{.lines = lines_, .mine = {}, .known = known_};
  for (const protocol::ChatLine& line : lines_)
    part.mine.push_back(std::find(mine_.begin(), mine_.end(), line.session) != mine_.end());
  return part;
}

}  // namespace earthwork::viewer
