#include "server/history/event.hpp"

#include "server/history/fold.hpp"

namespace earthwork::history {

void replay(voxel::Map& map, std::span<const Event> events) {
  for (const Event& event : events) apply(map, event.edit);
}

}  // namespace earthwork::history
