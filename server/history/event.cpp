#include "server/history/event.hpp"

#include "server/history/fold.hpp"

namespace earthwork::history {

void replay(voxel::Map& map, std::span<const Event> events) {
  for (const Event& event : events) apply(map, event.action);
}

std::optional<std::uint64_t> verify(voxel::Map& map, std::span<const Event> events) {
  for (const Event& event : events) {
    apply(map, event.action);
    if (map.hash() != event.hash) return event.seq;
  }
  return std::nullopt;
}

}  // namespace earthwork::history
