/// Tells whoever follows a map what it accepted: from a seq of the past on, and all that comes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "protocol/messages.hpp"
#include "server/history/event.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// The message that tells of an event.
[[nodiscard]] protocol::Event to_protocol(const history::Event& event);

/// A follower is a place in the list of events: it waits there as long as it likes, and costs
/// nothing. One thread at a time.
class EventFeed {
 public:
  /// From `from_seq` on, which is at least 1; whoever follows already starts anew from there.
  void follow(ViewerId id, std::uint64_t from_seq) { next_[id] = from_seq; }
  void leave(ViewerId id);
  /// Those who follow, each with the seq that it is told next.
  [[nodiscard]] const std::map<ViewerId, std::uint64_t>& followers() const { return next_; }

  /// Adds the next messages for the viewer, as many as fit into `bytes`; if `out` is empty at least
  /// one. `events` is all that was accepted, event n at n - 1. Nothing for who does not follow.
  void tell(ViewerId id, std::span<const history::Event> events, std::size_t bytes,
            std::vector<SharedText>& out);

 private:
  [[nodiscard]] SharedText text_of(const history::Event& event);

  std::map<ViewerId, std::uint64_t> next_;     // seq
  std::map<std::uint64_t, SharedText> texts_;  // by seq: of the latest that were told
  std::size_t texts_bytes_ = 0;
};

}  // namespace earthwork::room
