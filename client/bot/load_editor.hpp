/// An editor of a load run: paints a walk, at a rate or as fast as it is answered.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "client/bot/load_board.hpp"
#include "client/bot/load_walk.hpp"
#include "client/link/link.hpp"

namespace earthwork::bot {

/// Without a rate so many edits are without an answer, always.
inline constexpr std::size_t kLoadWindow = 64;
/// With a rate at most so many: a server that falls behind is not sent more.
inline constexpr std::size_t kLoadRateWindow = 1024;

struct EditorPlan {
  link::ServerAddress server;
  std::string map;
  PaintedSquare square;
  double radius = 3;
  std::uint64_t seed = 1;
  std::optional<double> edits_per_second;
  /// From the start of painting to the first edit, so that editors do not send in step.
  std::chrono::nanoseconds delay{0};
};

struct EditorCounts {
  std::uint64_t edits = 0;     ///< Handed to the link.
  std::uint64_t acked = 0;     ///< Of those, applied.
  std::uint64_t rejected = 0;  ///< Of those, refused.
  Histogram ack;               ///< From sending to `applied`.
  Histogram lag;               ///< With a rate: from the moment to send to the sending.
};

/// All on the loop's thread.
class LoadEditor {
 public:
  LoadEditor(link::EventLoop& loop, EditorPlan plan, LoadBoard& board);
  LoadEditor(const LoadEditor&) = delete;
  LoadEditor& operator=(const LoadEditor&) = delete;

  /// It has joined.
  [[nodiscard]] bool ready() const { return ready_; }
  void paint();
  /// Sends nothing more; answers are still taken.
  void stop();
  /// Every edit was answered, or its answer will never come.
  [[nodiscard]] bool answered() const { return in_flight_.empty() || lost_; }
  [[nodiscard]] const EditorCounts& counts() const { return counts_; }

 private:
  void take(const protocol::ServerMessage& message);
  void closed(const link::Closing& closing);
  void refused(const protocol::Failure& why);
  bool may_send() const;
  void send();
  void send_all_due();
  void fill_window();

  const EditorPlan plan_;
  LoadBoard& board_;
  BrushWalk walk_;
  EditorCounts counts_;
  std::unordered_map<protocol::MessageId, LoadClock::time_point> in_flight_;
  protocol::MessageId last_id_ = 0;
  bool ready_ = false, painting_ = false, lost_ = false;
  LoadClock::time_point due_;
  link::Timer timer_;
  link::Link link_;
};

}  // namespace earthwork::bot
