/// One's own painting: a drag becomes edits that go out as it is drawn, and what the server makes
/// of them is told where it happened.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/link/resume.hpp"
#include "client/scene/brush.hpp"
#include "client/scene/stroke.hpp"
#include "client/viewer/notices.hpp"

namespace earthwork::viewer {

class Painter {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// As Session::edit.
  using Keep = std::function<protocol::Result<protocol::MessageId>(const protocol::Edit&)>;

  /// The first stroke gets a number above `last_number`: none that the same author has used, or the
  /// server would take the first stroke for more of that one. `notices` outlives it.
  Painter(Keep keep, Notices& notices, std::int64_t last_number)
      : keep_(std::move(keep)), notices_(notices), next_number_(last_number + 1) {}

  /// A stroke begins, with a stamp that goes out at once; one that was going on has ended.
  void begin(const scene::BrushSettings& brush, const protocol::MapSettings& settings,
             protocol::MapPoint at, Time now);
  void draw_to(protocol::MapPoint at, Time now);
  /// Hands on what was drawn since. What cannot be kept is lost, and a notice says so.
  void flush(Time now);
  void end(Time now);
  /// What was not handed on yet is not painted.
  void cancel() { stroke_.reset(); }
  [[nodiscard]] bool painting() const { return stroke_.has_value(); }

  /// What became of edits, and of other things that were kept with them: tells what went wrong.
  void take(const std::vector<link::Answer>& answers, Time now);

 private:
  void tell_refused(const link::Answer& answer, Time now);
  std::optional<protocol::MapPoint> forget(protocol::MessageId id);

  Keep keep_;
  Notices& notices_;
  std::optional<scene::Stroke> stroke_;
  std::int64_t next_number_;
  bool told_full_ = false;                                  // in this stroke
  std::map<protocol::MessageId, protocol::MapPoint> ends_;  // where each unanswered edit ends
};

}  // namespace earthwork::viewer
