/// What all threads of a load run see: how far it is, and when edits were sent.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "client/bot/load_latency.hpp"
#include "client/link/link.hpp"

namespace earthwork::bot {

enum class LoadPhase {
  gathering,  ///< Everybody joins, and viewers get all of the map.
  painting,
  answering,  ///< Nothing more is sent; answers are due.
  settling,   ///< Every viewer reads at full speed until it shows `last_seq`.
  over,
};

/// Any thread.
class LoadBoard {
 public:
  std::atomic<LoadPhase> phase{LoadPhase::gathering};
  SendTimes sent;

  /// The highest number that an edit was given.
  [[nodiscard]] std::uint64_t last_seq() const { return last_seq_; }
  void raise_last_seq(std::uint64_t seq);

  /// A line for people; only the first few are kept.
  void tell(std::string line);
  /// The run cannot go on: the first cause is kept, and told.
  void fail(const link::Closing& why);
  [[nodiscard]] std::optional<link::Closing> failure() const;
  /// Those kept so far; they are told once.
  [[nodiscard]] std::vector<std::string> take_lines();

 private:
  std::atomic<std::uint64_t> last_seq_{0};
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  std::size_t told_ = 0;
  std::optional<link::Closing> failure_;
};

}  // namespace earthwork::bot
