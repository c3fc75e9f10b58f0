#include "server/room/chat_log.hpp"

#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::room {

std::size_t ChatArchive::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t ChatArchive::bytes_of(const Entry& entry) {
  const protocol::ChatLine& line = entry.line;
  constexpr std::size_t kLinks = 4 * sizeof(void*);  // of the list, and of the log's place
  return sizeof(Entry) + kLinks + line.session.size() + line.name.size() + line.color.size() +
         line.text.size();
}

// A log's lines are in the order of the archive: what goes first is the first of its log too.
void ChatArchive::drop(Entries::iterator entry) {
  entry->log->lines_.pop_front();
  bytes_ -= bytes_of(*entry);
  entries_.erase(entry);
}

ChatLog::ChatLog(std::shared_ptr<ChatArchive> archive) : archive_(std::move(archive)) {}

ChatLog::~ChatLog() {
  const std::lock_guard lock(archive_->mutex_);
  while (!lines_.empty()) archive_->drop(lines_.front());
}

std::uint64_t ChatLog::add(protocol::ChatLine line) {
  const std::lock_guard lock(archive_->mutex_);
  line.n = ++last_;
  auto& entries = archive_->entries_;
  lines_.push_back(entries.insert(entries.end(), {this, std::move(line)}));
  archive_->bytes_ += ChatArchive::bytes_of(entries.back());
  if (lines_.size() > protocol::kKeptChatLines) archive_->drop(lines_.front());
  while (archive_->bytes_ > archive_->most_bytes_) archive_->drop(entries.begin());
  return last_;
}

std::uint64_t ChatLog::last() const {
  const std::lock_guard lock(archive_->mutex_);
  return last_;
}

std::vector<protocol::ChatLine> ChatLog::after(std::uint64_t n) const {
  const std::lock_guard lock(archive_->mutex_);
  std::vector<protocol::ChatLine> lines;
  for (const auto& entry : lines_)
    if (entry->line.n > n) lines.push_back(entry->line);
  return lines;
}

}  // namespace earthwork::room
