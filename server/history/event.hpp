/// An accepted edit: its number in the map's one order, when it came, and from whom.
#pragma once

#include <cstdint>
#include <span>

#include "protocol/edit.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::history {

struct Event {
  std::uint64_t seq = 0;     ///< 1, 2, 3 ... without gaps.
  std::int64_t time_ms = 0;  ///< Since 1970, UTC.
  std::uint64_t author = 0;  ///< Names a key without giving it away.
  protocol::Edit edit;
};

/// Applies the events in order. The same events give the same map, whoever applies them.
void replay(voxel::Map& map, std::span<const Event> events);

}  // namespace earthwork::history
