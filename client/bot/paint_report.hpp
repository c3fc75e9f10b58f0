/// What painting came to, for scripts and for the shell.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/bot/exit_code.hpp"
#include "client/bot/painter.hpp"

namespace earthwork::bot {

/// {"edits","acked","rejected","seconds","ack_p50_ms","ack_p99_ms","seq"}; the two latencies are
/// null when nothing was applied.
[[nodiscard]] nlohmann::ordered_json write_report(const PaintReport& report);

/// kUsage when the map could not be joined at all, kFailed when an edit was refused or is without
/// an answer or was not sent.
[[nodiscard]] ExitCode exit_code(const PaintReport& report);

}  // namespace earthwork::bot
