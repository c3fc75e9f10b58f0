/// What a load run came to, for scripts and for the shell.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "client/bot/exit_code.hpp"
#include "client/bot/load_run.hpp"

namespace earthwork::bot {

/// {"editors","viewers","seconds","edits","edits_per_s","acked","rejected","frames","frames_per_s",
/// "groups_per_s","records","bytes","bytes_per_edit_and_viewer","voxel_bytes_per_edit",
/// "ack_ms":{"p50","p99","p999"},"view_ms":{likewise},"healthy":{"viewers","agreeing"},"slow",
/// "stalled","flaky": likewise,"reconnects","mesh_hash","seq",
/// "generator":{"threads","busy","lag_p99_ms","generator_limited"}}.
///
/// Rates are those of painting; frames, groups, records and bytes count to the last picture, and
/// of binary messages alone. Bytes per edit and viewer are those of the healthy viewers. What is
/// not known is null. `voxel_bytes_per_edit` is `mean_voxel_bytes`.
[[nodiscard]] nlohmann::ordered_json write_report(const LoadPlan& plan, const LoadReport& report,
                                                  double voxel_bytes_per_edit);

/// kUsage when painting did not begin because the map could not be joined; kDone only when every
/// viewer agrees with the server and every edit was applied.
[[nodiscard]] ExitCode exit_code(const LoadReport& report);

}  // namespace earthwork::bot
