#include "server/room/authors.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace earthwork::room {

Authors::Authors(std::span<const journal::AuthorState> states) {
  for (const journal::AuthorState& state : states) {
    const std::size_t count = std::min(state.applied.size(), protocol::kMaxRememberedIds);
    if (count == 0) continue;
    const std::span<const Applied> last = std::span(state.applied).last(count);
    memories_[state.author].ring.assign(last.begin(), last.end());
  }
}

Authors::Verdict Authors::judge(std::uint64_t author, protocol::MessageId id) const {
  const auto found = memories_.find(author);
  if (found == memories_.end()) return {Standing::fresh, 0};
  const Memory& memory = found->second;
  const std::size_t count = memory.ring.size();
  if (id > memory.nth(count - 1).id) return {Standing::fresh, 0};

  std::size_t below = 0, end = count;  // how many ids are below this one
  while (below < end) {
    const std::size_t middle = (below + end) / 2;
    if (memory.nth(middle).id < id)
      below = middle + 1;
    else
      end = middle;
  }
  if (memory.nth(below).id == id) return {Standing::repeated, memory.nth(below).seq};
  const bool full = count == protocol::kMaxRememberedIds;
  return {below == 0 && full ? Standing::too_old : Standing::out_of_order, 0};
}

void Authors::applied(std::uint64_t author, protocol::MessageId id, std::uint64_t seq) {
  assert(judge(author, id).standing == Standing::fresh);
  tentative_.push_back({author, seq, memories_[author].add({id, seq})});
}

/// Gives back the one that had to go for it.
std::optional<Authors::Applied> Authors::Memory::add(const Applied& applied) {
  if (ring.size() < protocol::kMaxRememberedIds) {
    ring.push_back(applied);
    return std::nullopt;
  }
  const Applied forgotten = std::exchange(ring[oldest], applied);
  oldest = (oldest + 1) % ring.size();
  return forgotten;
}

/// Undoes the last `add`, which gave this.
void Authors::Memory::undo(const std::optional<Applied>& forgotten) {
  if (!forgotten) return ring.pop_back();
  oldest = (oldest + ring.size() - 1) % ring.size();
  ring[oldest] = *forgotten;
}

journal::AuthorState Authors::state(std::uint64_t author) const {
  journal::AuthorState state{.author = author, .applied = {}};
  const auto found = memories_.find(author);
  if (found == memories_.end()) return state;
  const std::size_t count = found->second.ring.size();
  state.applied.reserve(count);
  for (std::size_t n = 0; n < count; ++n) state.applied.push_back(found->second.nth(n));
  return state;
}

void Authors::keep(std::uint64_t seq) {
  while (!tentative_.empty() && tentative_.front().seq <= seq) tentative_.pop_front();
}

void Authors::take_back() {
  for (; !tentative_.empty(); tentative_.pop_back()) {
    const auto found = memories_.find(tentative_.back().author);
    found->second.undo(tentative_.back().forgotten);
    if (found->second.ring.empty()) memories_.erase(found);
  }
}

}  // namespace earthwork::room
