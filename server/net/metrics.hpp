/// What GET /metrics says: the server's work and load in the text format of Prometheus, 0.0.4.
#pragma once

#include <cstdint>
#include <string>

#include "server/net/survey.hpp"
#include "server/room/meters.hpp"

namespace earthwork::net {

inline constexpr const char* kMetricsContentType = "text/plain; version=0.0.4; charset=utf-8";

/// Of this process; 0 for what the system does not tell.
struct ProcessUsage {
  std::uint64_t resident_bytes = 0;
  double cpu_seconds = 0;  ///< User and system, all threads.
};
[[nodiscard]] ProcessUsage own_usage();

/// Every metric with its help. There is no metric for a single map or session, so its length does
/// not grow with them.
[[nodiscard]] std::string metrics_text(const room::Meters& meters, const MapTotals& totals,
                                       const ProcessUsage& usage);

}  // namespace earthwork::net
