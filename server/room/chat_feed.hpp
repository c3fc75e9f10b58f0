/// Tells whoever is on a map what is said there: first what was said before it came, then each new
/// line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "protocol/messages.hpp"
#include "server/room/chat_log.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// Of a message that holds lines: half of a talk, so that people and events have room beside them.
/// A hundred lines of a sentence each fit in.
inline constexpr std::size_t kMaxChatTextBytes = kMaxTalkBytes / 2;

/// A listener is a number, that of the last line it was told, however slowly it reads: what it is
/// owed are those of the kept lines that are above. On the strand of the room whose part it is.
class ChatFeed {
 public:
  explicit ChatFeed(std::shared_ptr<ChatLog> log);

  /// It is owed all lines that are kept.
  void enter(ViewerId id) { told_[id] = 0; }
  void leave(ViewerId id);
  void leave_all();

  /// The line gets its number. Everybody is owed it from the next `advance` on.
  void add(protocol::ChatLine line);
  /// Lines were added since the last `advance`.
  [[nodiscard]] bool changed() const { return changed_; }
  void advance();
  /// There is something to tell the viewer.
  [[nodiscard]] bool owes(ViewerId id) const;
  /// The lines that come next for the viewer, as many as fit into kMaxChatTextBytes and at least
  /// one; it knows them from now on. Null when there are none.
  [[nodiscard]] SharedText news_for(ViewerId id);

 private:
  struct News {
    SharedText text;         // null: none
    std::uint64_t last = 0;  // the number of its last line
  };
  [[nodiscard]] News write_news(std::uint64_t told) const;

  const std::shared_ptr<ChatLog> log_;
  std::uint64_t last_;  // the number up to which lines are told
  bool changed_ = false;
  std::map<ViewerId, std::uint64_t> told_;    // up to which number
  std::map<std::uint64_t, News> news_after_;  // up to `last_`, for who was told up to a number
};

}  // namespace earthwork::room
