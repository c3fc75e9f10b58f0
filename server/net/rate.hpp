/// A token bucket: how long to wait before the next message may be read.
#pragma once

#include <algorithm>
#include <chrono>

namespace earthwork::net {

class Rate {
 public:
  using Clock = std::chrono::steady_clock;

  Rate(double per_second, double burst, Clock::time_point now)
      : per_second_(per_second), burst_(burst), tokens_(burst), last_(now) {}

  /// Takes one token, and gives back how long from `now` until it was there: zero or more.
  std::chrono::nanoseconds take(Clock::time_point now) {
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    tokens_ = std::min(burst_, tokens_ + passed.count() * per_second_) - 1;
    const std::chrono::duration<double> wait(tokens_ < 0 ? -tokens_ / per_second_ : 0);
    return std::chrono::duration_cast<std::chrono::nanoseconds>(wait);
  }

 private:
  double per_second_, burst_, tokens_;
  Clock::time_point last_;
};

}  // namespace earthwork::net
