/// From an edit's sending to its picture: two clocks' readings, taken on different threads, brought
/// together by the edit's seq.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "client/bot/load_histogram.hpp"

namespace earthwork::bot {

using LoadClock = std::chrono::steady_clock;

/// When the edits of the last million seqs were sent. 16 MiB. Any thread.
class SendTimes {
 public:
  SendTimes();
  /// Of an edit that was answered with `seq` > 0.
  void tell(std::uint64_t seq, LoadClock::time_point sent);
  /// Nothing while it is not told, or no longer.
  [[nodiscard]] std::optional<LoadClock::time_point> sent(std::uint64_t seq) const;

 private:
  struct Entry {
    std::atomic<std::uint64_t> seq{0};
    std::atomic<LoadClock::rep> sent{0};
  };
  std::vector<Entry> entries_;
};

/// The pictures of one viewer. A picture may be there before its edits are answered: it waits for
/// their sending times, at most kMatchPatience.
class PictureTimes {
 public:
  static constexpr std::chrono::seconds kMatchPatience{5};

  /// The seq that the viewer shows before the first edit that counts.
  void begin(std::uint64_t seq) { last_seq_ = seq; }
  /// A picture as of `seq`, which never falls, is there.
  void shown(std::uint64_t seq, LoadClock::time_point at);
  /// Adds to `out` the time of every edit whose picture and sending time are known by now. Edits
  /// that are not told in time are left out.
  void match(const SendTimes& times, LoadClock::time_point now, Histogram& out);

 private:
  struct Picture {
    std::uint64_t seq;
    LoadClock::time_point at;
  };
  std::deque<Picture> pictures_;
  std::uint64_t last_seq_ = 0;  // matched or left out
};

}  // namespace earthwork::bot
