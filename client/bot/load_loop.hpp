/// A thread of a load run with its share of the editors and viewers, and how busy it is: a
/// generator that is late measures itself.
#pragma once

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "client/bot/load_editor.hpp"
#include "client/bot/load_viewer.hpp"

namespace earthwork::bot {

/// From `run` to `join` the members and the board are the thread's own; progress is for any.
class LoadLoop {
 public:
  LoadLoop(const std::vector<EditorPlan>& editors, const std::vector<ViewerPlan>& viewers,
           LoadBoard& board);
  LoadLoop(const LoadLoop&) = delete;
  LoadLoop& operator=(const LoadLoop&) = delete;
  /// Joins; the board's phase must be `over`.
  ~LoadLoop();

  /// Starts the thread, which follows the board's phases to the last.
  void run();
  void join();

  /// The board's phase is reached: all are there, every edit is answered, everybody shows the last
  /// seq. Only of the phase that is now.
  [[nodiscard]] bool done(LoadPhase phase) const { return done_ == phase; }

  /// After `join`.
  [[nodiscard]] const std::vector<std::unique_ptr<LoadEditor>>& editors() const { return editors_; }
  [[nodiscard]] const std::vector<std::unique_ptr<LoadViewer>>& viewers() const { return viewers_; }
  /// How late its timers were while painting.
  [[nodiscard]] const Histogram& lag() const { return lag_; }
  /// The thread's processor time while painting, 0 .. 1 of the time.
  [[nodiscard]] double busy() const { return busy_; }

 private:
  void tick();
  void enter(LoadPhase phase);
  bool reached(LoadPhase phase) const;
  void connect_some();

  LoadBoard& board_;
  link::EventLoop loop_;
  link::Timer timer_;
  std::vector<std::unique_ptr<LoadEditor>> editors_;
  std::vector<std::unique_ptr<LoadViewer>> viewers_;
  std::size_t connected_ = 0;  // viewers that were asked to
  LoadPhase phase_ = LoadPhase::gathering;
  std::atomic<LoadPhase> done_{LoadPhase::over};  // over: nothing yet
  LoadClock::time_point due_, painting_since_;
  std::chrono::nanoseconds cpu_before_{0};
  Histogram lag_;
  double busy_ = 0;
  std::thread thread_;
};

}  // namespace earthwork::bot
