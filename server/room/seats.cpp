#include "server/room/seats.hpp"

#include <utility>

namespace earthwork::room {

void Seats::enter(ViewerId id, std::shared_ptr<GuardedViewer> viewer) {
  seats_[id].viewer = std::move(viewer);
}

void Seats::owe_answer(ViewerId id) {
  if (const auto seat = seats_.find(id); seat != seats_.end()) ++seat->second.owed;
}

void Seats::answer(ViewerId id, Reply reply, std::uint64_t seq) {
  if (const auto seat = seats_.find(id); seat != seats_.end())
    seat->second.held.add(std::move(reply), seq);
}

void Seats::refuse_answers(std::uint64_t durable_seq, const protocol::Failure& why) {
  for (auto& [id, seat] : seats_) seat.held.refuse(durable_seq, why);
}

void Seats::tell_answers(std::uint64_t durable_seq) {
  for (auto& [id, seat] : seats_) {
    std::vector<Reply> told = seat.held.take(durable_seq);
    if (told.empty()) continue;
    seat.owed -= told.size();
    seat.viewer->answered(std::move(told));
  }
}

void Seats::tell_settings(const SharedText& message) {
  for (auto& [id, seat] : seats_)
    if (!seat.gone) seat.viewer->settings(message);
}

bool Seats::leaves_when_told(ViewerId id, std::function<void()> gone) {
  const auto seat = seats_.find(id);
  if (seat == seats_.end() || seat->second.owed == 0) return false;
  seat->second.gone = std::move(gone);
  return true;
}

std::vector<Seats::Leaver> Seats::take_leavers() {
  std::vector<Leaver> leavers;
  for (auto next = seats_.begin(); next != seats_.end();) {
    const auto seat = next++;
    const bool leaves = seat->second.gone && seat->second.owed == 0;
    if (!leaves && !seat->second.viewer->broken()) continue;
    leavers.push_back({seat->first, std::move(seat->second.viewer), std::move(seat->second.gone)});
    seats_.erase(seat);
  }
  return leavers;
}

void Seats::end(const protocol::Bye& bye) {
  for (auto& [id, seat] : std::exchange(seats_, {})) seat.viewer->end(bye);
}

}  // namespace earthwork::room
