/// Between a journal's events and those of a recording.
#pragma once

#include "protocol/recording.hpp"
#include "server/history/event.hpp"

namespace earthwork::app {

[[nodiscard]] protocol::RecordedEvent to_recorded(const history::Event& event);
[[nodiscard]] history::Event from_recorded(protocol::RecordedEvent event);

}  // namespace earthwork::app
