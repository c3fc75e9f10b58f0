/// Edits, and changes of layers, that wait to be applied, in an order that is fair to their
/// authors: who asks for much waits for it, and does not keep those waiting who ask for little.
///
/// Start-time fair queueing: an edit starts, on a clock that counts work, when the one before it
/// of its author would have ended, or now when there is none; the earliest start is served first.
/// Source: Goyal, Vin, Cheng, "Start-time Fair Queueing", SIGCOMM 1996.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>
#include <tuple>
#include <unordered_map>

#include "protocol/action.hpp"
#include "protocol/messages.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// Centres of edits that wait to be applied, of all viewers together; a change of layers counts as
/// one. A message that has one is much larger, so this bounds what a crowd of editors can make a
/// map hold.
inline constexpr std::size_t kMaxWaitingPoints = std::size_t{4} << 20;

/// An edit, or a change of layers, that somebody asks for.
struct Command {
  protocol::MessageId id = 0;
  std::uint64_t author = 0;
  protocol::Action action;
};

/// One thread at a time.
class Line {
 public:
  struct Waiting {
    ViewerId viewer = 0;
    Command command;
    std::uint64_t cost = 1;     ///< Of work, in any unit; at least 1, at most 2^32.
    std::int64_t since_ms = 0;  ///< When it came.
  };

  /// False when more than kMaxWaitingPoints would wait; then nothing happened.
  [[nodiscard]] bool push(Waiting waiting);
  /// Takes the next one out. The edits of one author come in the order in which they were pushed.
  /// Not when there is no next one.
  [[nodiscard]] Waiting pop();
  void clear();

  [[nodiscard]] bool has_next() const { return !heads_.empty(); }
  /// The one that `pop` would take. Valid until then.
  [[nodiscard]] const Waiting& next() const;
  /// Passes over the next one, and over what comes after it of its author: they wait, and keep
  /// their places, but are not next until `recall`.
  void put_aside();
  /// Takes out the one of this author that was put aside. Who comes after it of the author may be
  /// next.
  [[nodiscard]] Waiting take(std::uint64_t author);
  /// Nobody is passed over any more: who was, comes before whoever came later.
  void recall() { heads_.merge(aside_); }

  /// None waits, not even aside.
  [[nodiscard]] bool empty() const { return queues_.empty(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Centres of all that waits.
  [[nodiscard]] std::size_t points() const { return points_; }
  /// How long the one that came first has waited; 0 when none waits. Takes time with the authors
  /// who wait.
  [[nodiscard]] std::int64_t oldest_wait_ms(std::int64_t now_ms) const;

 private:
  struct Entry {
    Waiting waiting;
    std::uint64_t start = 0, number = 0;
    bool newcomer = false;  // nothing of its author waited, or was still to be paid for
  };
  // The first edit of an author: earlier starts first, of equal ones the cheaper, then the older.
  using Head = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;

  using Queues = std::unordered_map<std::uint64_t, std::deque<Entry>>;

  [[nodiscard]] static Head head_of(const std::deque<Entry>& queue);
  [[nodiscard]] Waiting take_first(Queues::iterator queue);
  void forget_the_paid();

  Queues queues_;                                          // by author, none empty
  std::set<Head> heads_, aside_;                           // of all queues, each in one of them
  std::unordered_map<std::uint64_t, std::uint64_t> ends_;  // by author: where its last edit ends
  std::uint64_t clock_ = 0, last_number_ = 0;
  std::size_t size_ = 0, points_ = 0, forget_at_ = 0;
};

}  // namespace earthwork::room
