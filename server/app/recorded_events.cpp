#include "server/app/recorded_events.hpp"

#include <utility>

namespace earthwork::app {

protocol::RecordedEvent to_recorded(const history::Event& event) {
  return {.seq = event.seq,
          .time_ms = event.time_ms,
          .author = event.author,
          .id = event.id,
          .action = event.action,
          .hash = event.hash};
}

history::Event from_recorded(protocol::RecordedEvent event) {
  return {.seq = event.seq,
          .time_ms = event.time_ms,
          .author = event.author,
          .id = event.id,
          .action = std::move(event.action),
          .hash = event.hash};
}

}  // namespace earthwork::app
