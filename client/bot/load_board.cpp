#include "client/bot/load_board.hpp"

#include <utility>

namespace earthwork::bot {
namespace {

constexpr std::size_t kToldLines = 20;

}  // namespace

void LoadBoard::raise_last_seq(std::uint64_t seq) {
  std::uint64_t known = last_seq_;
  while (seq > known && !last_seq_.compare_exchange_weak(known, seq)) {
  }
}

void LoadBoard::tell(std::string line) {
  const std::scoped_lock lock(mutex_);
  if (++told_ <= kToldLines) lines_.push_back(std::move(line));
  if (told_ == kToldLines + 1) lines_.emplace_back("more of this is not told");
}

void LoadBoard::fail(const link::Closing& why) {
  const std::scoped_lock lock(mutex_);
  if (failure_) return;
  failure_ = why;
  lines_.push_back(why.failure.detail);
}

std::optional<link::Closing> LoadBoard::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

std::vector<std::string> LoadBoard::take_lines() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(lines_, {});
}

}  // namespace earthwork::bot
