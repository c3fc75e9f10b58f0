#include "client/bot/paint_report.hpp"

#include <nlohmann/json.hpp>

namespace earthwork::bot {

nlohmann::ordered_json write_report(const PaintReport& report) {
  const auto or_null = [](std::optional<double> value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  return {{"edits", report.edits},
          {"acked", report.acked},
          {"rejected", report.rejected},
          {"seconds", report.seconds},
          {"ack_p50_ms", or_null(percentile(report.ack_ms, 50))},
          {"ack_p99_ms", or_null(percentile(report.ack_ms, 99))},
          {"seq", report.seq}};
}

ExitCode exit_code(const PaintReport& report) {
  if (report.broken && !report.joined) return kUsage;
  return report.finished && report.rejected == 0 ? kDone : kFailed;
}

}  // namespace earthwork::bot
