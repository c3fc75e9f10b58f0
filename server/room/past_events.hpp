/// The durable events of a map, as somebody who follows them reads them: the latest from memory,
/// older ones in pages from the journal.
///
/// However many read the past, at however many places: one page is read at a time, as an idle task
/// of the clerk, so that a commit waits for one page at most; and the pages that are kept for who
/// comes next are bounded together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <optional>
#include <span>
#include <vector>

#include "protocol/result.hpp"
#include "server/history/event.hpp"
#include "server/journal/clerk.hpp"
#include "server/room/mesh_round.hpp"

namespace earthwork::room {

/// Of the latest events so many are kept, or fewer that take so much memory.
inline constexpr std::size_t kWindowEvents = 4096;
inline constexpr std::size_t kWindowBytes = std::size_t{1} << 20;
/// Of a page, as the journal counts; about what one talk can tell. So a reader whose page was let
/// go of before it had heard all has not read much in vain.
inline constexpr std::size_t kEventPageBytes = std::size_t{32} * 1024;
inline constexpr std::size_t kKeptPages = 16;

/// On the strand of the room whose part it is.
class PastEvents {
 public:
  /// The events 1 to `last_seq` are in the clerk's journal. `workplace` is called on the strand,
  /// for each page; its `back` brings the page, later or from within the call. The clerk outlives
  /// it.
  PastEvents(journal::Clerk& clerk, std::function<Workplace()> workplace, std::uint64_t last_seq);

  /// These are durable now; the first is number last_seq() + 1.
  void add(std::span<const history::Event> events);
  [[nodiscard]] std::uint64_t last_seq() const { return last_seq_; }

  /// The event number `seq`, 1 to last_seq(); null when it is in no page at hand: then one that
  /// begins with it is read, unless another is being read, and `came` is called when either is
  /// there. Valid until the next call of a function that is not const. Fails as Journal::events
  /// does, once for every attempt to read.
  [[nodiscard]] protocol::Result<const history::Event*> find(std::uint64_t seq);
  /// The first event of the page that is being read.
  [[nodiscard]] std::optional<std::uint64_t> reading() const { return reading_; }
  /// `came` is called when a page has come, or could not be read: on the strand, never from within
  /// a call of this.
  void when_page_comes(std::function<void()> came) { came_ = std::move(came); }

  /// Nobody reads the past now: lets go of the pages.
  void forget_pages() { pages_.clear(); }

 private:
  using Page = std::vector<history::Event>;  // one or more, without a gap
  struct Unreadable {
    std::uint64_t seq = 0;
    protocol::Failure why;
  };

  [[nodiscard]] const history::Event* at_hand(std::uint64_t seq);
  void read(std::uint64_t seq);
  void arrived(protocol::Result<Page> page);

  journal::Clerk& clerk_;
  const std::function<Workplace()> workplace_;
  std::function<void()> came_ = [] {};
  std::uint64_t last_seq_;
  std::deque<history::Event> window_;  // up to last_seq_
  std::size_t window_bytes_ = 0;
  std::list<Page> pages_;                 // the one used last first
  std::optional<std::uint64_t> reading_;  // from this seq on
  std::optional<Unreadable> unreadable_;  // that nobody was told of yet
  bool within_find_ = false;
};

}  // namespace earthwork::room
