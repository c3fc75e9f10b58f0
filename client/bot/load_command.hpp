/// earthwork-bot load: many editors and viewers at once, and what it costs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "client/bot/exit_code.hpp"
#include "client/bot/load_run.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::bot {

struct LoadOptions {
  std::string server, map;
  std::size_t editors = 1, viewers = 1;
  double seconds = 10;
  std::optional<double> rate;  ///< Edits a second of each editor.
  double radius = 3;           ///< Map units.
  double area = 256;           ///< The side of the square that is painted on, map units.
  std::size_t slow = 0, stalled = 0, flaky = 0;
  std::size_t threads = 1;
  bool create = false;  ///< The map with default settings.
  std::uint64_t seed = 1;
};

/// What the options ask for on a map with these settings, `server` left out. Fails with a sentence
/// when the bad ones are more than the viewers, when the map would refuse the edits, or when the
/// square is more than a view of everything holds.
[[nodiscard]] protocol::Result<LoadPlan> plan_load(const LoadOptions& options,
                                                   const protocol::MapSettings& settings);

/// Prints the report as one line on `out`, and what is to be said to people on `log`. Blocks.
[[nodiscard]] ExitCode load_command(const LoadOptions& options, std::ostream& out,
                                    std::ostream& log);

}  // namespace earthwork::bot
