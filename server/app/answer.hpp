/// What a subcommand says, and the exit code that goes with it: results on stdout, a JSON object a
/// line; everything else on stderr.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "protocol/result.hpp"

namespace earthwork::app {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;  ///< The work failed, or was refused in part.
inline constexpr int kUsage = 2;   ///< Wrong usage, or nothing to work on.

/// Prints a result. kDone, or kFailed when stdout does not take it.
[[nodiscard]] int answer(const nlohmann::ordered_json& line);
/// Tells people something on a line of its own.
void warn(const std::string& sentence);
/// Says why not, and gives back `exit_code`.
int refuse(int exit_code, const std::string& why);
/// The same with the exit code that fits the failure: kUsage for what could be asked otherwise - no
/// such map, a name or number that cannot be, a folder in use - and kFailed for all else.
int refuse(const protocol::Failure& failure);

}  // namespace earthwork::app
