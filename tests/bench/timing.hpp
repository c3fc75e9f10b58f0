/// Time as benchmarks measure it, and the line of JSON that they print.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace earthwork::bench {

/// Seconds; of the whole process where they are processor time.
struct Sample {
  double wall_s = 0, user_s = 0, sys_s = 0;
};

/// What one call takes.
Sample time_once(const std::function<void()>& work);

/// A call that is not counted, then `reps` calls (>= 1) that are.
std::vector<Sample> time_each(int reps, const std::function<void()>& work);

/// The value that a share of `values` (not empty) lies at or below, 0 < share <= 1; reorders them.
double percentile(std::vector<double>& values, double share);

struct Report {
  std::string tool;
  std::string data;  ///< The field's name.
  int threads = 1;
  std::vector<Sample> samples;  ///< At least one; the line gives the median of each figure.
  double work = 0;              ///< Units of work in a sample.
  std::string unit;
  std::vector<std::pair<std::string, double>> figures;  ///< Further keys, in order.
};

/// One line of JSON, without its end; also the process's largest memory so far, peak_rss_mb.
std::string to_line(const Report& report);

}  // namespace earthwork::bench
