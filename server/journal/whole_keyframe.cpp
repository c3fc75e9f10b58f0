#include "server/journal/whole_keyframe.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace earthwork::journal {
namespace {

using protocol::Result;

constexpr std::size_t kStatesAtOnce = 1024;

Result<void> put_chunks_after(Journal& journal, const Execution& executed, std::uint64_t seq) {
  std::vector<ChunkState> states;
  const auto put = [&]() -> Result<void> {
    if (states.empty()) return {};
    auto done = journal.put_chunks(states);
    states.clear();
    return done;
  };
  for (const ChunkAge& age : executed.ages.in_order()) {
    if (age.seq <= seq) continue;
    const voxel::Chunk* chunk = executed.map.find(age.key);
    states.push_back(
        {age.key, age.seq, chunk ? *chunk : voxel::Chunk(executed.map.grid().resolution)});
    if (states.size() < kStatesAtOnce) continue;
    if (auto done = put(); !done) return done;
  }
  return put();
}

}  // namespace

Result<void> put_whole_keyframe(Journal& journal, const Execution& executed, std::int64_t time_ms) {
  const auto keyframes = journal.keyframes();
  if (!keyframes) return tl::unexpected<protocol::Failure>(keyframes.error());
  const std::uint64_t last = keyframes->empty() ? 0 : keyframes->back().seq;
  if (last == executed.seq) return {};
  if (auto put = put_chunks_after(journal, executed, last); !put) return put;
  if (auto put = journal.put_authors(executed.authors.states()); !put) return put;
  return journal.put_keyframe({.seq = executed.seq,
                               .map_hash = executed.hash,
                               .time_ms = time_ms,
                               .settings = executed.settings});
}

}  // namespace earthwork::journal
