#include "server/net/survey.hpp"

#include <algorithm>
#include <exception>
#include <utility>

namespace earthwork::net {

void MapTotals::add(const room::RoomLoad& load) {
  viewers += load.viewers;
  waiting_edits += load.waiting_edits;
  dirty_chunks += load.dirty_chunks;
  owed_chunks += load.owed_chunks;
  oldest_wait_ms = std::max<std::int64_t>(oldest_wait_ms, load.oldest_wait_ms);
}

void Survey::ask(Told told) {
  const auto rooms = atlas_.rooms();
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(told));
    if (waiting_.size() > 1) return;
    totals_ = {.maps = atlas_.list().size(), .open_maps = rooms.size()};
    unanswered_ = rooms.size();
  }
  if (rooms.empty()) return finish();
  for (const auto& room : rooms) {
    room->strand().post([self = shared_from_this(), room] {
      std::optional<room::RoomLoad> load;
      try {
        load = room->load();
      } catch (const std::exception&) {  // this map is left out, and the others are told of
      }
      self->answer(load);
    });
  }
}

void Survey::answer(const std::optional<room::RoomLoad>& load) {
  {
    const std::lock_guard lock(mutex_);
    if (load) totals_.add(*load);
    if (--unanswered_ > 0) return;
  }
  finish();
}

void Survey::finish() {
  std::vector<Told> waiting;
  MapTotals totals;
  {
    const std::lock_guard lock(mutex_);
    waiting.swap(waiting_);
    totals = totals_;
  }
  for (const Told& told : waiting) told(totals);
}

}  // namespace earthwork::net
