/// How long to wait before a connection is tried again. Random, so that a thousand clients of a
/// server that was started again do not all come at once.
#pragma once

#include <chrono>
#include <cstdint>
#include <random>

namespace earthwork::link {

inline constexpr std::chrono::milliseconds kFirstDelay{250};
inline constexpr std::chrono::milliseconds kLongestDelay{30'000};
/// What a server may ask for; it waits no longer for more.
inline constexpr std::chrono::milliseconds kLongestAskedDelay{3'600'000};

class Backoff {
 public:
  explicit Backoff(std::uint64_t seed) : random_(seed) {}

  /// A time in [d/2, d], d being kFirstDelay at first and twice as much each time, up to
  /// kLongestDelay. Where a server asked for a wait, it is no less than `asked`, and spread over
  /// half as much again.
  [[nodiscard]] std::chrono::milliseconds next(std::chrono::milliseconds asked = {});
  /// The next delay is a first one again.
  void restart() { delay_ = kFirstDelay; }

 private:
  std::mt19937_64 random_;
  std::chrono::milliseconds delay_ = kFirstDelay;
};

}  // namespace earthwork::link
