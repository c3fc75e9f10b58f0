#include "server/room/ledger.hpp"

#include <atomic>
#include <cassert>
#include <chrono>
#include <utility>

#include "server/room/caught.hpp"

namespace earthwork::room {
namespace {

using Clock = std::chrono::steady_clock;

std::size_t bytes_of(const history::Event& event) {
  return sizeof event + protocol::points(event.action) * sizeof(protocol::MapPoint);
}

}  // namespace

/// Shared with the clerk's thread, which writes `result` and touches nothing else of it.
struct Ledger::Batch {
  enum class State { posting, posted, ended };

  std::uint64_t expected_seq = 0;
  Events events;
  Milestone last;  // what the map is after them
  Clock::time_point start = Clock::now();
  protocol::Result<void> result;
  std::atomic<State> state{State::posting};

  void append_to(journal::Journal& journal) {
    result = caught([&] { return journal.append(expected_seq, events); });
  }
};

Ledger::Ledger(journal::Clerk& clerk, const Milestone& start, std::shared_ptr<Meters> meters)
    : clerk_(clerk), meters_(std::move(meters)), durable_(start), accepted_seq_(start.seq) {}

Ledger::~Ledger() {
  meters_->waiting_events -= static_cast<std::int64_t>(accepted_seq_ - durable_.seq);
}

void Ledger::accept(history::Event event) {
  assert(event.seq == accepted_seq_ + 1);
  ++accepted_seq_;
  ++meters_->waiting_events;
  gathered_bytes_ += bytes_of(event);
  gathered_.push_back(std::move(event));
}

bool Ledger::full() const {
  return gathered_.size() >= kMaxGatheredEvents || gathered_bytes_ >= kMaxGatheredBytes;
}

// Whoever of the two comes second to the state, the call that posts or the task, goes on with the
// result: so an append that ends within the call is known of within it, on whatever thread it ran.
bool Ledger::hand_over(std::size_t chunks, std::function<void()> ended_later) {
  assert(can_hand_over());
  batch_ = std::make_shared<Batch>();
  batch_->expected_seq = accepted_seq_ - gathered_.size();
  batch_->last = {accepted_seq_, gathered_.back().hash, chunks};
  batch_->events = std::exchange(gathered_, {});
  gathered_bytes_ = 0;
  using State = Batch::State;
  clerk_.post(journal::Urgency::now,
              [batch = batch_, later = std::move(ended_later)](journal::Journal& journal) {
                batch->append_to(journal);
                if (batch->state.exchange(State::ended) == State::posted) later();
              });
  return batch_->state.exchange(State::posted) == State::ended;
}

protocol::Result<Ledger::Events> Ledger::settle(std::int64_t now_ms) {
  assert(batch_);
  const std::shared_ptr<Batch> batch = std::exchange(batch_, nullptr);
  if (!batch->result) {
    note_failure(batch->result.error(), now_ms);
    return tl::unexpected<protocol::Failure>(batch->result.error());
  }
  note_success(*batch);
  return std::move(batch->events);
}

void Ledger::note_success(const Batch& batch) {
  durable_ = batch.last;
  trouble_.reset();
  const auto took =
      std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - batch.start);
  ++meters_->commits;
  meters_->committed_events += batch.events.size();
  meters_->commit_ns += static_cast<std::uint64_t>(took.count());
  meters_->waiting_events -= static_cast<std::int64_t>(batch.events.size());
}

void Ledger::note_failure(const protocol::Failure& failure, std::int64_t now_ms) {
  trouble_ = failure;
  trouble_ms_ = now_ms;
  ++meters_->journal_failures[static_cast<std::size_t>(failure.code)];
  meters_->waiting_events -= static_cast<std::int64_t>(accepted_seq_ - durable_.seq);
  gathered_.clear();
  gathered_bytes_ = 0;
  accepted_seq_ = durable_.seq;
  for (Waiter& waiter : waiters_)
    if (waiter.seq > durable_.seq) waiter.kept = false;
}

// A clock that was set back must not make it last longer.
const protocol::Failure* Ledger::trouble(std::int64_t now_ms) const {
  const bool now = trouble_ && now_ms >= trouble_ms_ && now_ms - trouble_ms_ < kPauseMs;
  return now ? &*trouble_ : nullptr;
}

void Ledger::once_durable(std::function<void(bool)> then) {
  if (idle()) return then(true);
  waiters_.push_back({.seq = accepted_seq_, .then = std::move(then)});
}

void Ledger::tell_waiters() {
  while (!waiters_.empty()) {
    Waiter& next = waiters_.front();
    if (next.kept && next.seq > durable_.seq) return;
    const Waiter told = std::move(next);
    waiters_.pop_front();
    told.then(told.kept);
  }
}

void Ledger::give_up() {
  for (Waiter& waiter : waiters_) waiter.kept = false;
  tell_waiters();
}

}  // namespace earthwork::room
