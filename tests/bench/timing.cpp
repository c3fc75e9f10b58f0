#include "tests/bench/timing.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace earthwork::bench {
namespace {

double seconds(timeval t) {
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
}

rusage usage() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return u;
}

double median(const std::vector<Sample>& samples, double Sample::*figure) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(sample.*figure);
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

double rate(double work, double time_s) { return time_s > 0 ? work / time_s : 0; }

}  // namespace

Sample time_once(const std::function<void()>& work) {
  const rusage before = usage();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const rusage after = usage();
  return {wall.count(), seconds(after.ru_utime) - seconds(before.ru_utime),
          seconds(after.ru_stime) - seconds(before.ru_stime)};
}

std::vector<Sample> time_each(int reps, const std::function<void()>& work) {
  work();
  std::vector<Sample> samples;
  for (int i = 0; i < reps; ++i) samples.push_back(time_once(work));
  return samples;
}

double percentile(std::vector<double>& values, double share) {
  assert(!values.empty() && share > 0 && share <= 1);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::string to_line(const Report& report) {
  assert(!report.samples.empty());
  const double wall_s = median(report.samples, &Sample::wall_s);
  const double user_s = median(report.samples, &Sample::user_s);
  const double sys_s = median(report.samples, &Sample::sys_s);
  const auto [least, most] =
      std::minmax_element(report.samples.begin(), report.samples.end(),
                          [](const Sample& a, const Sample& b) { return a.wall_s < b.wall_s; });
  std::string line = fmt::format(
      R"({{"tool":"{}","data":"{}","threads":{},"reps":{},"wall_s":{:.6g},"user_s":{:.6g},)"
      R"("sys_s":{:.6g},"wall_min_s":{:.6g},"wall_max_s":{:.6g},"work":{:.0f},"unit":"{}","per_wall_s":{:.6g},"per_cpu_s":{:.6g})",
      report.tool, report.data, report.threads, report.samples.size(), wall_s, user_s, sys_s,
      least->wall_s, most->wall_s, report.work, report.unit, rate(report.work, wall_s),
      rate(report.work, user_s + sys_s));
  for (const auto& [key, value] : report.figures) {
    line += fmt::format(R"(,"{}":{:.10g})", key, value);
  }
  line += fmt::format(R"(,"peak_rss_mb":{}}})", usage().ru_maxrss / 1024);
  return line;
}

}  // namespace earthwork::bench
