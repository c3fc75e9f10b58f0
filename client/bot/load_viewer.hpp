/// A viewer of a load run: has all of the map, and may be a bad one - slow, stalled, or gone again
/// and again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "client/bot/load_board.hpp"
#include "client/link/link.hpp"
#include "client/scene/scene.hpp"

namespace earthwork::bot {

enum class Manner {
  healthy,
  slow,     ///< Reads 1 KB a second.
  stalled,  ///< Reads nothing for the first two thirds of the painting, a minute at most.
  flaky,    ///< Cuts its connection at random moments, and comes back.
};

struct ViewerPlan {
  link::ServerAddress server;
  std::string map;
  Manner manner = Manner::healthy;
  std::uint64_t seed = 1;
  bool sampled = false;  ///< Measures when edits are shown.
  std::chrono::nanoseconds painting{0};
};

/// Since painting began.
struct ViewerCounts {
  std::uint64_t frames = 0, groups = 0, records = 0, bytes = 0;
  std::uint64_t reconnects = 0;
  Histogram view;  ///< Of a sampled one: from an edit's sending to the end of the group with it.
};

/// All on the loop's thread. A connection that was cut, by whomever, is made again, and what the
/// scene holds is claimed then.
class LoadViewer {
 public:
  LoadViewer(link::EventLoop& loop, ViewerPlan plan, LoadBoard& board);
  LoadViewer(const LoadViewer&) = delete;
  LoadViewer& operator=(const LoadViewer&) = delete;

  void connect();
  [[nodiscard]] bool connecting() const { return link_ && !ready_; }
  /// It has had all of the map once.
  [[nodiscard]] bool ready() const { return ready_; }
  /// Painting begins: counts from now on, and follows its manner.
  void misbehave();
  /// From now on it is as good as a healthy one.
  void let_go();
  /// Now and then.
  void match_times();
  [[nodiscard]] bool shows(std::uint64_t seq) const;

  [[nodiscard]] Manner manner() const { return plan_.manner; }
  [[nodiscard]] const ViewerCounts& counts() const { return counts_; }
  [[nodiscard]] const scene::Scene& scene() const { return scene_; }

 private:
  void look();
  void take(const protocol::ServerMessage& message);
  void take(std::vector<protocol::FrameEvent>& events, std::size_t bytes);
  void count(const std::vector<protocol::FrameEvent>& events, std::size_t bytes);
  void closed(const link::Closing& closing);
  void come_back();
  void cut_some_time();
  void read_on_later(std::size_t bytes);
  std::chrono::nanoseconds between(std::chrono::nanoseconds low, std::chrono::nanoseconds high);

  link::EventLoop& loop_;
  const ViewerPlan plan_;
  LoadBoard& board_;
  std::mt19937_64 random_;
  scene::Scene scene_;
  std::uint32_t view_ = 0;
  protocol::MapSettings settings_;
  ViewerCounts counts_;
  PictureTimes pictures_;
  bool ready_ = false, counting_ = false, bad_ = false, broken_ = false;
  link::Timer manner_timer_, return_timer_;
  std::unique_ptr<link::Link> link_;
};

}  // namespace earthwork::bot
