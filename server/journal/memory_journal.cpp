#include "server/journal/memory_journal.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "server/journal/kept_keyframes.hpp"

namespace earthwork::journal {
namespace {

using history::Event;
using protocol::Code;
using protocol::fail;
using protocol::Result;
using voxel::ChunkKey;

std::size_t bytes_of(const Event& event) {
  return sizeof(Event) + protocol::points(event.action) * sizeof(protocol::MapPoint);
}

class MemoryJournal final : public Journal {
 public:
  explicit MemoryJournal(Identity identity) : identity_(std::move(identity)) {}

  const Identity& identity() const override { return identity_; }
  std::uint64_t last_seq() const override { return events_.size(); }

  Result<void> append(std::uint64_t expected_seq, std::span<const Event> events) override;
  Result<std::vector<Event>> events(std::uint64_t from_seq, std::size_t most_bytes) override;
  Result<void> put_chunks(std::span<const ChunkState> states) override;
  Result<void> put_authors(std::span<const AuthorState> authors) override;
  Result<void> put_keyframe(const Keyframe& keyframe) override;
  Result<bool> tidy(std::size_t most) override;
  Result<std::vector<Keyframe>> keyframes() override { return keyframes_; }
  Result<void> chunks(std::uint64_t seq,
                      const std::function<Result<void>(ChunkState)>& take) override;
  Result<std::vector<AuthorState>> authors() override;

 private:
  using States = std::map<std::uint64_t, voxel::Chunk>;  // by seq

  std::uint64_t newest_keyframe() const { return keyframes_.empty() ? 0 : keyframes_.back().seq; }
  void drop_keyframes();
  std::size_t remove_superseded(States& states, std::size_t most) const;

  Identity identity_;
  std::vector<Event> events_;  // that of seq s at s - 1
  std::vector<Keyframe> keyframes_;
  std::map<ChunkKey, States> chunks_;
  std::map<std::uint64_t, AuthorState> authors_;
  ChunkKey tidy_next_;  // where tidying goes on, within a round of all keys
  bool tidying_ = false;
};

Result<void> MemoryJournal::append(std::uint64_t expected_seq, std::span<const Event> events) {
  if (expected_seq != last_seq())
    return fail(Code::bad_state, "the last event is " + std::to_string(last_seq()) + ", not " +
                                     std::to_string(expected_seq));
  for ([[maybe_unused]] std::uint64_t seq = expected_seq; [[maybe_unused]] const Event& e : events)
    assert(e.seq == ++seq);
  events_.insert(events_.end(), events.begin(), events.end());
  return {};
}

Result<std::vector<Event>> MemoryJournal::events(std::uint64_t from_seq, std::size_t most_bytes) {
  std::vector<Event> page;
  std::size_t bytes = 0;
  for (std::size_t i = std::max<std::uint64_t>(from_seq, 1) - 1; i < events_.size(); ++i) {
    bytes += bytes_of(events_[i]);
    if (bytes > most_bytes && !page.empty()) break;
    page.push_back(events_[i]);
  }
  return page;
}

Result<void> MemoryJournal::put_chunks(std::span<const ChunkState> states) {
  for (const ChunkState& state : states)
    if (state.seq <= newest_keyframe() || state.seq > last_seq())
      return fail(Code::bad_state, "a chunk's state of event " + std::to_string(state.seq) +
                                       " belongs to no keyframe to come");
  for (const ChunkState& state : states)
    chunks_[state.key].insert_or_assign(state.seq, state.chunk);
  return {};
}

Result<void> MemoryJournal::put_authors(std::span<const AuthorState> authors) {
  for (const AuthorState& author : authors) authors_[author.author] = author;
  return {};
}

Result<void> MemoryJournal::put_keyframe(const Keyframe& keyframe) {
  if (keyframe.seq <= newest_keyframe() || keyframe.seq > last_seq())
    return fail(Code::bad_state, "a keyframe of event " + std::to_string(keyframe.seq) +
                                     " cannot follow that of " + std::to_string(newest_keyframe()));
  keyframes_.push_back(keyframe);
  tidying_ = false;
  return {};
}

void MemoryJournal::drop_keyframes() {
  std::vector<std::uint64_t> seqs;
  for (const Keyframe& keyframe : keyframes_) seqs.push_back(keyframe.seq);
  const auto kept = kept_keyframes(seqs);
  std::erase_if(keyframes_, [&kept](const Keyframe& keyframe) {
    return !std::binary_search(kept.begin(), kept.end(), keyframe.seq);
  });
}

// A state is needed by the keyframes from its own seq to before the next one's.
std::size_t MemoryJournal::remove_superseded(States& states, std::size_t most) const {
  std::size_t removed = 0;
  for (auto it = states.begin(); it != states.end() && removed < most;) {
    const auto next = std::next(it);
    const auto needed = std::lower_bound(
        keyframes_.begin(), keyframes_.end(), it->first,
        [](const Keyframe& keyframe, std::uint64_t seq) { return keyframe.seq < seq; });
    if (needed == keyframes_.end() || (next != states.end() && next->first <= needed->seq)) {
      states.erase(it);
      ++removed;
    }
    it = next;
  }
  return removed;
}

Result<bool> MemoryJournal::tidy(std::size_t most) {
  if (!tidying_) drop_keyframes();
  auto it = tidying_ ? chunks_.lower_bound(tidy_next_) : chunks_.begin();
  for (std::size_t removed = 0; it != chunks_.end();) {
    removed += remove_superseded(it->second, most - removed);
    tidying_ = removed == most;
    if (tidying_) {
      tidy_next_ = it->first;
      return false;
    }
    it = it->second.empty() ? chunks_.erase(it) : std::next(it);
  }
  tidying_ = false;
  return true;
}

Result<void> MemoryJournal::chunks(std::uint64_t seq,
                                   const std::function<Result<void>(ChunkState)>& take) {
  if (std::none_of(keyframes_.begin(), keyframes_.end(),
                   [seq](const Keyframe& keyframe) { return keyframe.seq == seq; }))
    return fail(Code::bad_state, "there is no keyframe of event " + std::to_string(seq));
  for (const auto& [key, states] : chunks_) {
    const auto after = states.upper_bound(seq);
    if (after == states.begin()) continue;
    const auto& [since, chunk] = *std::prev(after);
    if (auto taken = take({.key = key, .seq = since, .chunk = chunk}); !taken) return taken;
  }
  return {};
}

Result<std::vector<AuthorState>> MemoryJournal::authors() {
  std::vector<AuthorState> all;
  for (const auto& [author, state] : authors_) all.push_back(state);
  return all;
}

}  // namespace

std::unique_ptr<Journal> make_memory_journal(Identity identity) {
  return std::make_unique<MemoryJournal>(std::move(identity));
}

}  // namespace earthwork::journal
