/// earthwork-bot run: an edit script, sent in order.
#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>

#include "client/bot/exit_code.hpp"

namespace earthwork::bot {

/// A script file may be this long.
inline constexpr std::size_t kMaxScriptBytes = std::size_t{256} * 1024 * 1024;

struct RunOptions {
  std::string script;  ///< A path.
  std::string server, map;
  bool create = false;
  std::size_t window = 64;
  std::optional<double> rate;                  ///< Edits a second.
  std::chrono::milliseconds patience{60'000};  ///< As of PaintOptions.
};

/// Reads the whole script before anything is sent. Prints the report as one line on `out`, and
/// what is to be said to people on `log`. Blocks.
[[nodiscard]] ExitCode run_command(const RunOptions& options, std::ostream& out, std::ostream& log);

}  // namespace earthwork::bot
