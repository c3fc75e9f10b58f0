/// Strands without threads: their tasks run when the context's owner says so, and time passes when
/// told.
#pragma once

#include <chrono>
#include <deque>
#include <limits>
#include <map>
#include <memory>

#include "server/room/strand.hpp"

namespace earthwork::room {

/// One thread only. Outlives its strands; tasks that never ran end with it.
class ManualContext {
 public:
  /// All strands of a context share one order, and so does what they post aside.
  [[nodiscard]] std::unique_ptr<Strand> make_strand();

  /// Runs tasks, also those that they post, until none is left or `most` have run. Gives back how
  /// many ran. What a task throws comes out; the next call goes on with those after it.
  int run(int most = std::numeric_limits<int>::max());
  /// Lets time pass, and runs what falls due meanwhile.
  void advance(std::chrono::milliseconds time);
  [[nodiscard]] std::chrono::milliseconds now() const { return now_; }

 private:
  class ManualStrand;

  std::deque<Strand::Task> tasks_;
  std::multimap<std::chrono::milliseconds, Strand::Task> later_;  // by when they fall due
  std::chrono::milliseconds now_{0};
};

}  // namespace earthwork::room
