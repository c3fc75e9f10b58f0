/// How fast a session may talk: kMaxChatLines lines in any kChatSeconds.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/limits.hpp"

namespace earthwork::net {

class ChatRate {
 public:
  /// Asks whether a line may be said now, and counts it when it may. Otherwise gives back in how
  /// many milliseconds one may, 1 .. kChatSeconds * 1000. A clock that was set back silences
  /// nobody.
  [[nodiscard]] std::optional<std::int64_t> take(std::int64_t now_ms) {
    constexpr std::int64_t kWindowMs = std::int64_t{protocol::kChatSeconds} * 1000;
    std::erase_if(said_ms_, [&](std::int64_t said_ms) {
      return said_ms > now_ms || now_ms - said_ms >= kWindowMs;
    });
    if (said_ms_.size() >= protocol::kMaxChatLines) return said_ms_.front() + kWindowMs - now_ms;
    said_ms_.push_back(now_ms);
    return std::nullopt;
  }

 private:
  std::vector<std::int64_t> said_ms_;  // in the last kChatSeconds, oldest first
};

}  // namespace earthwork::net
