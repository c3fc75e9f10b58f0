#include "server/net/metrics.hpp"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <utility>
#include <vector>

namespace earthwork::net {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

constexpr double kNanosecond = 1e-9, kMicrosecond = 1e-6, kMillisecond = 1e-3;

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * kMicrosecond;
}

/// Counters only rise while the server runs; gauges say how it is now.
ClientMetric measured(MetricType type, double value) {
  ClientMetric metric;
  (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
  return metric;
}

/// A page of metrics, line by line.
class Page {
 public:
  template <class Number>
  void gauge(const char* name, const char* help, Number value) {
    add(name, help, MetricType::Gauge, static_cast<double>(value));
  }
  template <class Number>
  void counter(const char* name, const char* help, Number value) {
    add(name, help, MetricType::Counter, static_cast<double>(value));
  }
  void add(MetricFamily family) { families_.push_back(std::move(family)); }
  [[nodiscard]] std::string text() const {
    return prometheus::TextSerializer().prometheus::Serializer::Serialize(families_);
  }

 private:
  void add(const char* name, const char* help, MetricType type, double value) {
    add({name, help, type, {measured(type, value)}});
  }

  std::vector<MetricFamily> families_;
};

template <class Counts>
MetricFamily by_code(const char* family_name, const char* help, const Counts& counts) {
  MetricFamily family{family_name, help, MetricType::Counter, {}};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    ClientMetric metric = measured(MetricType::Counter, static_cast<double>(counts[i].load()));
    metric.label = {{"code", std::string(name(static_cast<protocol::Code>(i)))}};
    family.metric.push_back(std::move(metric));
  }
  return family;
}

void add_work(Page& page, const room::Meters& meters) {
  page.gauge("earthwork_sessions", "WebSocket sessions that are open.", meters.sessions.load());
  page.counter("earthwork_edits_total", "Edits that were accepted and numbered.",
               meters.edits.load());
  page.counter("earthwork_edits_repeated_total",
               "Edits that were sent again after they had been applied, and only answered.",
               meters.repeated.load());
  page.counter("earthwork_chat_lines_total", "Lines of chat that were said.",
               meters.chat_lines.load());
  page.add(by_code("earthwork_rejected_total",
                   "Messages that were refused, by the code of the refusal.", meters.rejected));
  page.counter("earthwork_meshed_chunks_total", "Meshes of chunks that were made.",
               meters.meshed_chunks.load());
  page.counter("earthwork_mesh_seconds_total",
               "Time that making meshes took, all threads added up.",
               static_cast<double>(meters.mesh_ns.load()) * kNanosecond);
  page.counter("earthwork_frames_total", "Binary messages, which carry meshes, that were sent.",
               meters.frames.load());
  page.counter("earthwork_frame_bytes_total", "Bytes of those.", meters.frame_bytes.load());
  page.counter("earthwork_controls_total", "Text messages that were sent.", meters.controls.load());
  page.counter("earthwork_control_bytes_total", "Bytes of those.", meters.control_bytes.load());
}

void add_journals(Page& page, const room::Meters& meters) {
  page.counter("earthwork_commits_total", "Batches of edits that were stored.",
               meters.commits.load());
  page.counter("earthwork_committed_events_total", "Edits in those batches.",
               meters.committed_events.load());
  page.counter("earthwork_commit_seconds_total",
               "Time from when a batch was handed over until it was stored, all added up.",
               static_cast<double>(meters.commit_ns.load()) * kNanosecond);
  page.gauge("earthwork_waiting_events",
             "Edits that were accepted and are not stored yet: nobody was told of them.",
             meters.waiting_events.load());
  page.counter("earthwork_keyframes_total", "States of maps that were stored beside their edits.",
               meters.keyframes.load());
  page.add(by_code("earthwork_journal_failures_total",
                   "What could not be stored, opened or removed, by the code of the failure.",
                   meters.journal_failures));
}

void add_load(Page& page, const MapTotals& totals) {
  page.gauge("earthwork_maps", "Maps that there are.", totals.maps);
  page.gauge("earthwork_open_maps", "Maps that are in memory.", totals.open_maps);
  page.gauge("earthwork_viewers", "Sessions that have joined a map.", totals.viewers);
  page.gauge("earthwork_waiting_edits", "Edits that were received and not applied yet.",
             totals.waiting_edits);
  page.gauge("earthwork_queue_age_seconds",
             "How long the one of them that came first has waited. When it grows, the server "
             "cannot keep up with the editors.",
             static_cast<double>(totals.oldest_wait_ms) * kMillisecond);
  page.gauge("earthwork_dirty_chunks", "Chunks that changed and were not meshed again yet.",
             totals.dirty_chunks);
  page.gauge("earthwork_owed_chunks",
             "Chunks that viewers have yet to be sent, all viewers added up. When it grows, "
             "viewers or the network are slower than the edits.",
             totals.owed_chunks);
}

}  // namespace

ProcessUsage own_usage() {
  ProcessUsage usage;
  rusage times{};
  if (getrusage(RUSAGE_SELF, &times) == 0)
    usage.cpu_seconds = seconds(times.ru_utime) + seconds(times.ru_stime);
  std::ifstream pages("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  if (pages >> all >> resident)
    usage.resident_bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return usage;
}

std::string metrics_text(const room::Meters& meters, const MapTotals& totals,
                         const ProcessUsage& usage) {
  Page page;
  add_work(page, meters);
  add_journals(page, meters);
  add_load(page, totals);
  page.gauge("process_resident_memory_bytes", "Memory that the process has in use.",
             usage.resident_bytes);
  page.counter("process_cpu_seconds_total", "CPU time, of all threads, user and system.",
               usage.cpu_seconds);
  return page.text();
}

}  // namespace earthwork::net
