/// Tells whoever follows a map what it accepted: from a seq of the past on, and all that comes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "protocol/messages.hpp"
#include "server/history/event.hpp"
#include "server/room/past_events.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// The message that tells of an event.
[[nodiscard]] protocol::Event to_protocol(const history::Event& event);

/// A follower is a place in the list of events: it waits there as long as it likes, and costs
/// nothing. On the strand of the room whose part it is.
class EventFeed {
 public:
  /// From `from_seq` on, which is at least 1; whoever follows already starts anew from there.
  void follow(ViewerId id, std::uint64_t from_seq) { next_[id] = from_seq; }
  void leave(ViewerId id);
  /// Those who follow, in the order in which they are to be told when a page of the past has come:
  /// so that whoever reads the past gets a page in turn.
  [[nodiscard]] std::vector<ViewerId> followers() const;
  [[nodiscard]] bool empty() const { return next_.empty(); }

  /// Adds the next messages for the viewer, as many as fit into `bytes`; if `out` is empty at least
  /// one. Ends before an event that `events` has to read first. When that cannot be read, a
  /// `rejected` without an id says so, and the viewer follows no more. Nothing for who does not
  /// follow.
  void tell(ViewerId id, PastEvents& events, std::size_t bytes, std::vector<SharedText>& out);

 private:
  [[nodiscard]] SharedText text_of(const history::Event& event);

  std::map<ViewerId, std::uint64_t> next_;     // seq
  ViewerId last_reader_ = 0;                   // for whom a page was read last
  std::map<std::uint64_t, SharedText> texts_;  // by seq: of the latest that were told
  std::size_t texts_bytes_ = 0;
};

}  // namespace earthwork::room
