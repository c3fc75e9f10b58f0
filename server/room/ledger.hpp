/// Brings what a map accepts into its journal: what comes while one append is in flight gathers,
/// and goes together in the next. So however slow a disk is, a commit carries all that waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/result.hpp"
#include "server/history/event.hpp"
#include "server/journal/clerk.hpp"
#include "server/room/meters.hpp"
#include "server/room/milestone.hpp"

namespace earthwork::room {

/// When so much has gathered, no more is accepted until the append in flight has ended.
inline constexpr std::size_t kMaxGatheredEvents = 4096;
inline constexpr std::size_t kMaxGatheredBytes = std::size_t{8} << 20;
/// For so long after an append has failed nothing is tried again.
inline constexpr std::int64_t kPauseMs = 1000;

/// On the strand of the room whose part it is.
class Ledger {
 public:
  using Events = std::vector<history::Event>;

  /// `start` is the journal's last event. The clerk outlives the ledger.
  Ledger(journal::Clerk& clerk, const Milestone& start, std::shared_ptr<Meters> meters);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  /// What everybody may know of.
  [[nodiscard]] const Milestone& durable() const { return durable_; }
  /// The map's own seq: of the last event that was accepted, durable or not.
  [[nodiscard]] std::uint64_t accepted_seq() const { return accepted_seq_; }
  /// The next event, of accepted_seq() + 1.
  void accept(history::Event event);
  /// So much has gathered that the map should wait.
  [[nodiscard]] bool full() const;
  /// Nothing has gathered, and nothing is in flight.
  [[nodiscard]] bool idle() const { return gathered_.empty() && !batch_; }

  /// Something has gathered, and nothing is in flight.
  [[nodiscard]] bool can_hand_over() const { return !gathered_.empty() && !batch_; }

  /// Hands all that has gathered to the clerk, when that can be; the map has `chunks` chunks now.
  /// True when the append has ended within the call; else `ended_later` is called, on any thread,
  /// when it has. Either way `settle` is next.
  [[nodiscard]] bool hand_over(std::size_t chunks, std::function<void()> ended_later);
  /// What came of the append that has ended: its events, which are durable now; or why none of them
  /// is. Then what has gathered meanwhile is forgotten too, and nothing is accepted that was not
  /// durable. `now_ms` is the time.
  [[nodiscard]] protocol::Result<Events> settle(std::int64_t now_ms);

  /// Why nothing should be tried now: an append has failed less than kPauseMs ago.
  [[nodiscard]] const protocol::Failure* trouble(std::int64_t now_ms) const;

  /// Calls `then` when all that is accepted by now is durable, with true, or taken back, with
  /// false: within the call when there is nothing to wait for, else from `tell_waiters`.
  void once_durable(std::function<void(bool kept)> then);
  void tell_waiters();
  /// Whoever waits is told false.
  void give_up();

 private:
  struct Batch;
  struct Waiter {
    std::uint64_t seq;
    std::function<void(bool)> then;
    bool kept = true;
  };

  void note_success(const Batch& batch);
  void note_failure(const protocol::Failure& failure, std::int64_t now_ms);

  journal::Clerk& clerk_;
  const std::shared_ptr<Meters> meters_;
  Milestone durable_;
  std::uint64_t accepted_seq_;
  Events gathered_;
  std::size_t gathered_bytes_ = 0;
  std::shared_ptr<Batch> batch_;  // in flight
  std::deque<Waiter> waiters_;    // their seqs rise
  std::optional<protocol::Failure> trouble_;
  std::int64_t trouble_ms_ = 0;
};

}  // namespace earthwork::room
