/// earthwork-bot watch: what a viewer of everything receives.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "client/bot/exit_code.hpp"

namespace earthwork::bot {

struct WatchCommandOptions {
  std::string server, map;
  std::optional<std::uint64_t> until_seq;
  std::optional<double> seconds;
  std::optional<std::string> glb;              ///< A path.
  std::chrono::milliseconds patience{60'000};  ///< As of WatchOptions.
};

/// Prints {"seq","frames","bytes","chunks","mesh_hash"} as one line on `out`, and what is to be
/// said to people on `log`. Blocks.
[[nodiscard]] ExitCode watch_command(const WatchCommandOptions& options, std::ostream& out,
                                     std::ostream& log);

}  // namespace earthwork::bot
