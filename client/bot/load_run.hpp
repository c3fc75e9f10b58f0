/// A load run: editors that paint, viewers that watch, good and bad ones, and what became of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "client/bot/load_histogram.hpp"
#include "client/bot/load_viewer.hpp"
#include "client/bot/load_walk.hpp"
#include "client/link/link.hpp"

namespace earthwork::bot {

struct LoadPlan {
  link::ServerAddress server;
  std::string map;
  std::size_t editors = 1, viewers = 1;          ///< The bad ones are among the viewers.
  std::size_t slow = 0, stalled = 0, flaky = 0;  ///< Together at most `viewers`.
  double seconds = 10;
  std::optional<double> edits_per_second;  ///< Of each editor.
  PaintedSquare square;
  double radius = 3;  ///< Map units.
  std::size_t threads = 1;
  std::uint64_t seed = 1;
};

struct Agreement {
  std::uint64_t viewers = 0;
  std::uint64_t agreeing = 0;  ///< Their scene is the server's, as of the last edit.
};

struct LoadReport {
  double seconds = 0;  ///< Of painting.
  std::uint64_t edits = 0, acked = 0, rejected = 0;
  std::uint64_t frames = 0, groups = 0, records = 0, bytes = 0;  ///< To all viewers together.
  std::uint64_t healthy_bytes = 0;                               ///< To the healthy ones.
  std::uint64_t reconnects = 0;
  Histogram ack, view;
  Agreement healthy, slow, stalled, flaky;
  std::uint64_t seq = 0;
  std::optional<std::uint64_t> mesh_hash;  ///< The server's, at the end.
  double busy = 0;                         ///< Of the busiest thread of the generator.
  Histogram lag;
  bool painted = false;  ///< Everybody had joined, and painting began.
  bool interrupted = false;
  std::optional<link::Closing> failure;  ///< Why painting did not begin.

  [[nodiscard]] bool all_agree() const;
  /// The generator was late or had no time left: what was measured is partly its own doing.
  [[nodiscard]] bool generator_limited() const;
};

/// Beyond either the generator is the limit.
inline constexpr double kMaxBusy = 0.8, kMaxLag_ms = 1;

/// A figure of GET .../figures.
struct MapPicture {
  std::uint64_t seq = 0, mesh_hash = 0;
};
[[nodiscard]] protocol::Result<MapPicture> map_picture(const link::ServerAddress& server,
                                                       const std::string& map);

/// Paints, lets the bad ones go, waits until every viewer shows the last edit, at most two minutes,
/// and compares. The first SIGINT or SIGTERM ends the painting early, the next one all. What goes
/// wrong is told on `log`, a line each. Blocks; threads of its own.
[[nodiscard]] LoadReport run_load(const LoadPlan& plan, std::ostream& log);

/// The manner of viewer `index` of so many: the bad ones come first.
[[nodiscard]] Manner manner_of(const LoadPlan& plan, std::size_t index);

}  // namespace earthwork::bot
