#include "client/bot/load_report.hpp"

#include <nlohmann/json.hpp>

#include "protocol/chunk_record.hpp"

namespace earthwork::bot {
namespace {

using nlohmann::ordered_json;

ordered_json or_null(std::optional<double> value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

/// null of nothing.
ordered_json quotient(double value, double of) {
  return of > 0 ? ordered_json(value / of) : ordered_json(nullptr);
}

ordered_json percentiles(const Histogram& times) {
  return {{"p50", or_null(times.percentile_ms(50))},
          {"p99", or_null(times.percentile_ms(99))},
          {"p999", or_null(times.percentile_ms(99.9))}};
}

ordered_json written(const Agreement& those) {
  return {{"viewers", those.viewers}, {"agreeing", those.agreeing}};
}

}  // namespace

ordered_json write_report(const LoadPlan& plan, const LoadReport& report,
                          double voxel_bytes_per_edit) {
  const auto per_second = [&](std::uint64_t count) {
    return quotient(static_cast<double>(count), report.seconds);
  };
  const auto edits_and_viewers =
      static_cast<double>(report.acked) * static_cast<double>(report.healthy.viewers);
  return {{"editors", plan.editors},
          {"viewers", plan.viewers},
          {"seconds", report.seconds},
          {"edits", report.edits},
          {"edits_per_s", per_second(report.acked)},
          {"acked", report.acked},
          {"rejected", report.rejected},
          {"frames", report.frames},
          {"frames_per_s", per_second(report.frames)},
          {"groups_per_s", per_second(report.groups)},
          {"records", report.records},
          {"bytes", report.bytes},
          {"bytes_per_edit_and_viewer",
           quotient(static_cast<double>(report.healthy_bytes), edits_and_viewers)},
          {"voxel_bytes_per_edit",
           report.acked > 0 ? ordered_json(voxel_bytes_per_edit) : ordered_json(nullptr)},
          {"ack_ms", percentiles(report.ack)},
          {"view_ms", percentiles(report.view)},
          {"healthy", written(report.healthy)},
          {"slow", written(report.slow)},
          {"stalled", written(report.stalled)},
          {"flaky", written(report.flaky)},
          {"reconnects", report.reconnects},
          {"mesh_hash", report.mesh_hash ? ordered_json(protocol::hex(*report.mesh_hash))
                                         : ordered_json(nullptr)},
          {"seq", report.seq},
          {"generator",
           {{"threads", plan.threads},
            {"busy", report.busy},
            {"lag_p99_ms", or_null(report.lag.percentile_ms(99))},
            {"generator_limited", report.generator_limited()}}}};
}

ExitCode exit_code(const LoadReport& report) {
  using link::CloseCause;
  if (report.failure && (report.failure->cause == CloseCause::unreachable ||
                         report.failure->cause == CloseCause::refused))
    return kUsage;
  const bool all_applied = report.painted && report.acked == report.edits;
  return all_applied && report.all_agree() && !report.interrupted ? kDone : kFailed;
}

}  // namespace earthwork::bot
