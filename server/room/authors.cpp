#include "server/room/authors.hpp"

#include <cassert>

namespace earthwork::room {

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
  Memory& memory = memories_[author];
  if (memory.ring.size() < protocol::kMaxRememberedIds) {
    memory.ring.push_back({id, seq});
    return;
  }
  memory.ring[memory.oldest] = {id, seq};
  memory.oldest = (memory.oldest + 1) % memory.ring.size();
}

}  // namespace earthwork::room
