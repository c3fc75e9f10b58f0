/// What a map was after an event.
#pragma once

#include <cstddef>
#include <cstdint>

namespace earthwork::room {

struct Milestone {
  std::uint64_t seq = 0;   ///< 0 before the first event.
  std::uint64_t hash = 0;  ///< voxel::Map::hash()
  std::size_t chunks = 0;  ///< Kept: with a filled voxel or a crossing.
  friend bool operator==(const Milestone&, const Milestone&) = default;
};

}  // namespace earthwork::room
