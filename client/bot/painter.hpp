/// Sends edits, and changes of layers, to a map and waits for the answers, a bounded number of them
/// at a time; when the connection breaks, over another one.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/link/closing.hpp"
#include "client/link/server_address.hpp"
#include "protocol/script.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

struct PaintOptions {
  link::ServerAddress server;
  std::string map;
  std::size_t window = 64;                 ///< Edits without an answer, at most; at least 1.
  std::optional<double> edits_per_second;  ///< None: as fast as they are answered.
  /// Without a connection for so long, the server is gone for good.
  std::chrono::milliseconds patience{60'000};
};

struct PaintReport {
  /// Changes of layers too: sent, or to be sent over the next connection.
  std::uint64_t edits = 0;
  std::uint64_t acked = 0;     ///< Of those, applied.
  std::uint64_t rejected = 0;  ///< Of those, refused by the server, or too long to be sent.
  double seconds = 0;          ///< From the answer to the first join to the last answer.
  std::vector<double> ack_ms;  ///< From sending to `applied`, in the order of the answers.
  std::uint64_t seq = 0;       ///< Of the last edit applied; of the join before there is one.
  bool finished = false;       ///< Every step was taken and every edit answered.
  bool interrupted = false;
  bool joined = false;                  ///< The map was joined, once at least.
  std::optional<link::Closing> broken;  ///< Why it ended early, unless it was told to.
};

/// Takes the steps in order. Refused edits, and why it ends early, are told on `log`, a line each.
/// On SIGINT or SIGTERM it sends nothing more and waits a second for the answers that are due; a
/// second signal ends that. Blocks; a loop of its own.
[[nodiscard]] PaintReport paint(const PaintOptions& options,
                                std::span<const protocol::ScriptStep> steps, std::ostream& log);

/// The nearest-rank percentile, 0 < percent <= 100; nothing of no values.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double percent);

}  // namespace earthwork::bot
