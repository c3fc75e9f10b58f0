#include "server/room/chat_feed.hpp"

#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace earthwork::room {
namespace {

// Those who keep up are told the same, and so are those who come in. Of who reads slowly each may
// be elsewhere: its text is written when it takes it.
constexpr std::size_t kSharedTexts = 8;

}  // namespace

ChatFeed::ChatFeed(std::shared_ptr<ChatLog> log) : log_(std::move(log)), last_(log_->last()) {}

void ChatFeed::leave(ViewerId id) {
  told_.erase(id);
  if (told_.empty()) news_after_.clear();
}

void ChatFeed::leave_all() {
  told_.clear();
  news_after_.clear();
}

void ChatFeed::add(protocol::ChatLine line) {
  log_->add(std::move(line));
  changed_ = true;
}

void ChatFeed::advance() {
  last_ = log_->last();
  changed_ = false;
  news_after_.clear();
}

bool ChatFeed::owes(ViewerId id) const {
  const auto found = told_.find(id);
  return found != told_.end() && found->second < last_;
}

SharedText ChatFeed::news_for(ViewerId id) {
  if (!owes(id)) return nullptr;
  std::uint64_t& told = told_.at(id);
  auto news = news_after_.find(told);
  if (news == news_after_.end()) {
    // Those at the ends are for who comes in and for who keeps up.
    if (news_after_.size() == kSharedTexts) news_after_.erase(std::next(news_after_.begin()));
    news = news_after_.emplace(told, write_news(told)).first;
  }
  told = news->second.last;
  return news->second.text;
}

ChatFeed::News ChatFeed::write_news(std::uint64_t told) const {
  protocol::ChatLines chat;
  std::size_t bytes = 0;
  for (protocol::ChatLine& line : log_->after(told)) {
    if (line.n > last_) break;
    bytes += protocol::write(protocol::ChatLines{{line}}).size();
    if (bytes > kMaxChatTextBytes && !chat.lines.empty()) break;
    chat.lines.push_back(std::move(line));
  }
  if (chat.lines.empty()) return {nullptr, last_};  // later lines took their place
  const std::uint64_t last = chat.lines.back().n;
  return {std::make_shared<const std::string>(protocol::write(chat)), last};
}

}  // namespace earthwork::room
