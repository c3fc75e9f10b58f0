/// What a map accepted: its number in the map's one order, when it came, from whom, and what the
/// map was after it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "protocol/action.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::history {

struct Event {
  std::uint64_t seq = 0;     ///< 1, 2, 3 ... without gaps.
  std::int64_t time_ms = 0;  ///< Since 1970, UTC.
  std::uint64_t author = 0;  ///< Names a key without giving it away.
  std::int64_t id = 0;       ///< The author's own number of it: with it, it is known again.
  protocol::Action action;
  std::uint64_t hash = 0;  ///< voxel::Map::hash() after it.
};

/// Applies the events in order. The same events give the same map, whoever applies them.
void replay(voxel::Map& map, std::span<const Event> events);

/// The same, and compares the map's hash after each event. Stops at the first that differs, and
/// gives back its seq; nothing when all agree.
[[nodiscard]] std::optional<std::uint64_t> verify(voxel::Map& map, std::span<const Event> events);

}  // namespace earthwork::history
