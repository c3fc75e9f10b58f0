/// A drag of the brush, as the edits it is made of: stamps along the way, so close that no gap is
/// left, in as few edits as go out at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/scene/brush.hpp"
#include "protocol/chunk_range.hpp"
#include "protocol/edit.hpp"
#include "protocol/settings.hpp"

namespace earthwork::scene {

/// What a server groups into one step of undo at most.
inline constexpr int kMaxStrokeStamps = 4096;
inline constexpr std::chrono::seconds kMaxStrokeTime{60};

class Stroke {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Begins with a stamp at `at`. `number` names the stroke; when it grows beyond what a step of
  /// undo holds, it goes on under the next number. It snaps as `snap_of` the brush tells.
  Stroke(const BrushSettings& brush, const protocol::MapSettings& settings, std::int64_t number,
         protocol::MapPoint at, Time now);

  /// The brush was drawn on, in a straight line. Stamps are a quarter of the radius apart, and at
  /// least half a voxel; snapped, every place on the way, once in a row and each beside the one
  /// before. Past 100,000 stamps at once, they are further apart. Of what is not finite, or 10^12
  /// voxels from 0, nothing comes.
  void draw_to(protocol::MapPoint to, Time now);
  /// The brush was lifted: a last stamp where it is, which evenly spaced ones have not reached.
  void finish(Time now);
  /// What was not handed out yet, in order: each edit passes `check_edit`, has a path and carries
  /// the stroke's number. Stamps that could not pass or change anything, outside of the world or
  /// of the map's bounds, are left out.
  [[nodiscard]] std::vector<protocol::Edit> take();
  /// The number that the next stroke may have.
  [[nodiscard]] std::int64_t next_number() const { return number_ + 1; }

 private:
  void draw_evenly(protocol::MapPoint from, protocol::MapPoint to, Time now);
  void draw_places(protocol::MapPoint from, protocol::MapPoint to, Time now);
  void stamp(protocol::MapPoint at, Time now);
  void add_to_edit(protocol::MapPoint at, const protocol::ChunkRange& touched);

  BrushSettings brush_;
  protocol::MapSettings settings_;
  double radius_ = 0;         // map units
  protocol::MapRect useful_;  // the centres that can matter
  std::int64_t number_ = 0;
  int stamps_ = 0;                             // under that number
  Time began_;                                 // that number
  protocol::MapPoint last_;                    // where the pointer was
  double since_last_ = 0;                      // map units drawn since the last stamp
  std::optional<protocol::MapPoint> stamped_;  // the last stamp's centre
  std::vector<protocol::Edit> ready_;
  protocol::ChunkRange touched_last_;  // by the last stamp of the last edit
  std::uint64_t chunks_ = 0;           // counted for the last edit
};

}  // namespace earthwork::scene
