/// Threads for what takes long: encoding exports and pictures, away from sockets and rooms.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace earthwork::net {

inline constexpr std::size_t kMaxWaitingJobs = 16;

/// Any thread may offer jobs.
class Workers {
 public:
  explicit Workers(int threads);
  /// Drops what waits, and waits for what runs.
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// False when kMaxWaitingJobs wait already: the job is not taken. What a job
  /// throws is logged, and ends that job alone.
  [[nodiscard]] bool offer(std::function<void()> job);
  /// Whether a job would be refused now: asked before making what a job would need.
  [[nodiscard]] bool full() const;

 private:
  void work();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool ending_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace earthwork::net
