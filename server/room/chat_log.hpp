/// What was said on a map: its last lines, for as long as the server knows the map.
///
/// A log belongs to the map and not to its room, which leaves memory when nobody is inside: who
/// comes back finds the talk. Nothing of it is stored on disk; a server that starts has said
/// nothing yet. All logs of a server together have a bound, so that thousands of maps with long
/// talk cannot fill its memory: beyond it the oldest line goes first, whichever map it is of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "protocol/messages.hpp"

namespace earthwork::room {

/// Of all lines that a server keeps; a line of 500 characters takes up to 2.4 KiB.
inline constexpr std::size_t kMaxChatBytes = std::size_t{16} << 20;

class ChatLog;

/// Where the lines of all logs are, oldest first. Any thread.
class ChatArchive {
 public:
  explicit ChatArchive(std::size_t most_bytes = kMaxChatBytes) : most_bytes_(most_bytes) {}
  /// Of memory, about: never above `most_bytes`.
  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class ChatLog;
  struct Entry {
    ChatLog* log = nullptr;
    protocol::ChatLine line;
  };
  using Entries = std::list<Entry>;

  [[nodiscard]] static std::size_t bytes_of(const Entry& entry);
  void drop(Entries::iterator entry);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;  // of the logs' lines too
  Entries entries_;
  std::size_t bytes_ = 0;
};

/// The talk of one map. Any thread. Its lines leave the archive with it.
class ChatLog {
 public:
  explicit ChatLog(std::shared_ptr<ChatArchive> archive = std::make_shared<ChatArchive>());
  ~ChatLog();
  ChatLog(const ChatLog&) = delete;
  ChatLog& operator=(const ChatLog&) = delete;

  /// Numbers the line, one above the last, and keeps it; of more than kKeptChatLines the first
  /// goes. Gives back the number.
  std::uint64_t add(protocol::ChatLine line);
  /// The number of the last line that was added; 0 before the first.
  [[nodiscard]] std::uint64_t last() const;
  /// Those of the kept lines whose numbers are above `n`, in order.
  [[nodiscard]] std::vector<protocol::ChatLine> after(std::uint64_t n) const;

 private:
  friend class ChatArchive;

  const std::shared_ptr<ChatArchive> archive_;
  std::deque<ChatArchive::Entries::iterator> lines_;
  std::uint64_t last_ = 0;
};

}  // namespace earthwork::room
