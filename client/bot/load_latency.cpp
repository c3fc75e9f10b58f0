#include "client/bot/load_latency.hpp"

namespace earthwork::bot {
namespace {

constexpr std::size_t kEntries = std::size_t{1} << 20;

}  // namespace

SendTimes::SendTimes() : entries_(kEntries) {}

void SendTimes::tell(std::uint64_t seq, LoadClock::time_point sent) {
  Entry& entry = entries_[seq % kEntries];
  entry.sent.store(sent.time_since_epoch().count(), std::memory_order_relaxed);
  entry.seq.store(seq, std::memory_order_release);
}

std::optional<LoadClock::time_point> SendTimes::sent(std::uint64_t seq) const {
  const Entry& entry = entries_[seq % kEntries];
  if (entry.seq.load(std::memory_order_acquire) != seq) return std::nullopt;
  return LoadClock::time_point(LoadClock::duration(entry.sent.load(std::memory_order_relaxed)));
}

void PictureTimes::shown(std::uint64_t seq, LoadClock::time_point at) {
  const std::uint64_t before = pictures_.empty() ? last_seq_ : pictures_.back().seq;
  if (seq > before) pictures_.push_back({.seq = seq, .at = at});
}

void PictureTimes::match(const SendTimes& times, LoadClock::time_point now, Histogram& out) {
  while (!pictures_.empty()) {
    const Picture& picture = pictures_.front();
    const bool patient = now - picture.at < kMatchPatience;
    while (last_seq_ < picture.seq) {
      const auto sent = times.sent(last_seq_ + 1);
      if (!sent && patient) return;
      if (sent) out.add(picture.at - *sent);
      ++last_seq_;
    }
    pictures_.pop_front();
  }
}

}  // namespace earthwork::bot
