#include "server/journal/restore.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "server/journal/damage.hpp"
#include "server/journal/event_pages.hpp"
#include "server/journal/execution.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::Failure;
using protocol::Result;

/// A chunk of the map's frame, from no later than its keyframe.
bool fits(const ChunkState& state, const voxel::Grid& grid, std::uint64_t keyframe_seq) {
  const voxel::ChunkKey& key = state.key;
  return state.seq <= keyframe_seq && key.z == 0 && key.layer >= 0 && key.layer < grid.layers &&
         grid.extent().contains(key.x, key.y) && state.chunk.resolution() == grid.resolution;
}

/// Settings that a map which began with `first` can have come to: layers are added and change.
bool follow(const protocol::MapSettings& settings, const protocol::MapSettings& first) {
  protocol::MapSettings with_layers = first;
  with_layers.layers = settings.layers;
  return settings == with_layers && settings.layers.size() >= first.layers.size();
}

Result<AuthorBook> load_authors(Journal& journal, std::uint64_t up_to) {
  auto known = journal.authors();
  if (!known) return tl::unexpected<Failure>(std::move(known.error()));
  for (const AuthorState& state : *known) {
    const auto not_above = [](const AuthorState::Applied& a, const AuthorState::Applied& b) {
      return b.id <= a.id || b.seq <= a.seq;
    };
    const auto wrong = std::ranges::adjacent_find(state.applied, not_above);
    if (wrong != state.applied.end())
      return damage(journal.name(), "authors", wrong->seq,
                    "what follows it of author " + protocol::hex(state.author) + " is not above");
  }
  return AuthorBook(std::move(*known), up_to);
}

Result<Execution> load_keyframe(Journal& journal, const Keyframe& keyframe) {
  if (!follow(keyframe.settings, journal.identity().settings))
    return damage(journal.name(), "keyframes", keyframe.seq, "settings that the map cannot have");
  Execution loaded(keyframe.settings);
  auto authors = load_authors(journal, keyframe.seq);
  if (!authors) return tl::unexpected<Failure>(std::move(authors.error()));
  loaded.authors = std::move(*authors);

  auto told = journal.chunks(keyframe.seq, [&](ChunkState state) -> Result<void> {
    if (!fits(state, loaded.map.grid(), keyframe.seq))
      return damage(journal.name(), "chunks", state.seq, "a chunk that the map cannot have");
    loaded.ages.set(state.key, state.seq);
    if (!state.chunk.blank()) loaded.map.put(state.key, std::move(state.chunk));
    return {};
  });
  if (!told) return tl::unexpected<Failure>(std::move(told.error()));
  loaded.seq = keyframe.seq;
  loaded.hash = loaded.map.hash();
  if (loaded.hash != keyframe.map_hash)
    return damage(journal.name(), "keyframes", keyframe.seq,
                  "the stored hash is " + protocol::hex(keyframe.map_hash) + ", its chunks give " +
                      protocol::hex(loaded.hash));
  // The log is the truth, as far as it can be read there.
  if (const auto event = journal.events(keyframe.seq, 1);
      event && !event->empty() && event->front().hash != loaded.hash)
    return damage(journal.name(), "keyframes", keyframe.seq,
                  "its chunks give hash " + protocol::hex(loaded.hash) + ", and the log says " +
                      protocol::hex(event->front().hash));
  return loaded;
}

Result<Restored> go_on(Journal& journal, Execution&& start, std::uint64_t target) {
  const std::uint64_t keyframe_seq = start.seq;
  auto executed = read_events(journal, start.seq, target, [&](const history::Event& event) {
    return start.apply(event).map_error(
        [&journal](Failure failure) { return in_events_of(journal, std::move(failure)); });
  });
  if (!executed) return tl::unexpected<Failure>(std::move(executed.error()));
  return Restored{.map = std::move(start.map),
                  .settings = std::move(start.settings),
                  .seq = start.seq,
                  .hash = start.hash,
                  .ages = start.ages.in_order(),
                  .authors = start.authors.states(),
                  .keyframe_seq = keyframe_seq,
                  .passed_over = {}};
}

Result<Restored> restore_from(Journal& journal, const Keyframe& keyframe, std::uint64_t target) {
  auto loaded = load_keyframe(journal, keyframe);
  if (!loaded) return tl::unexpected<Failure>(std::move(loaded.error()));
  return go_on(journal, std::move(*loaded), target);
}

}  // namespace

Result<Restored> restore(Journal& journal, std::optional<std::uint64_t> seq, Trust trust) {
  const std::uint64_t last = journal.last_seq();
  const std::uint64_t target = seq.value_or(last);
  if (target > last)
    return protocol::fail(
        Code::out_of_range,
        "seq: " + std::to_string(target) + " is beyond the last one, " + std::to_string(last),
        "seq");

  std::vector<Failure> passed_over;
  const auto may_pass_over = [&](const Failure& failure) {
    if (trust == Trust::strict || failure.code != Code::damaged) return false;
    passed_over.push_back(failure);
    return true;
  };
  auto keyframes = journal.keyframes();
  if (!keyframes && !may_pass_over(keyframes.error()))
    return tl::unexpected<Failure>(std::move(keyframes.error()));
  auto starts = keyframes ? std::move(*keyframes) : std::vector<Keyframe>{};
  if (!starts.empty() && starts.back().seq > last) {
    auto torn = damage(journal.name(), "keyframes", starts.back().seq,
                       "the log has only " + std::to_string(last) + " events");
    if (!may_pass_over(torn.value())) return torn;
  }
  std::erase_if(starts, [target](const Keyframe& keyframe) { return keyframe.seq > target; });

  for (; !starts.empty(); starts.pop_back()) {  // the newest first
    auto restored = restore_from(journal, starts.back(), target);
    if (!restored && may_pass_over(restored.error())) continue;
    if (restored) restored->passed_over = std::move(passed_over);
    return restored;
  }
  auto restored = go_on(journal, Execution(journal.identity().settings), target);
  if (restored) restored->passed_over = std::move(passed_over);
  return restored;
}

}  // namespace earthwork::journal
