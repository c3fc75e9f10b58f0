#include "client/link/backoff.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::link {

std::chrono::milliseconds Backoff::next(std::chrono::milliseconds asked) {
  asked = std::min(asked, kLongestAskedDelay);
  const auto delay = std::exchange(delay_, std::min(2 * delay_, kLongestDelay));
  const auto low = std::max(delay / 2, asked);
  const auto high = std::max(delay, asked + asked / 2);
  std::uniform_int_distribution<std::int64_t> between(low.count(), high.count());
  return std::chrono::milliseconds(between(random_));
}

}  // namespace earthwork::link
