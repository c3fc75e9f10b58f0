/// Sends edits to a map and waits for the answers, a bounded number of them at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "client/link/event_loop.hpp"
#include "client/link/link.hpp"
#include "protocol/script.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

struct PaintOptions {
  link::ServerAddress server;
  std::string map;
  std::size_t window = 64;                 ///< Edits without an answer, at most; at least 1.
  std::optional<double> edits_per_second;  ///< None: as fast as they are answered.
};

struct PaintReport {
  std::uint64_t edits = 0;     ///< Handed to the link.
  std::uint64_t acked = 0;     ///< Of those, applied.
  std::uint64_t rejected = 0;  ///< Of those, refused: by the server, or unsent by the link itself.
  double seconds = 0;          ///< From the answer to the join to the last answer.
  std::vector<double> ack_ms;  ///< From sending to `applied`, in the order of the answers.
  std::uint64_t seq = 0;       ///< Of the last edit applied; of the join before there is one.
  bool finished = false;       ///< Every step was taken and every edit answered.
  bool interrupted = false;
  std::optional<link::Closing> broken;  ///< Why the connection ended, unless it was to end.
};

/// Takes the steps in order. Refused edits, and why it ends early, are told on `log`, a line each.
/// On SIGINT or SIGTERM it sends nothing more and waits a second for the answers that are due; a
/// second signal ends that. Blocks; a loop of its own.
[[nodiscard]] PaintReport paint(const PaintOptions& options,
                                std::span<const protocol::ScriptStep> steps, std::ostream& log);

/// The nearest-rank percentile, 0 < percent <= 100; nothing of no values.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double percent);

}  // namespace earthwork::bot
