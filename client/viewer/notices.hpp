/// What a person is told that went wrong or happened, and where.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "client/viewer/panel_state.hpp"

namespace earthwork::viewer {

inline constexpr std::size_t kKeptNotices = 20;
/// How long its words stand beside its place on the map.
inline constexpr std::chrono::seconds kNoticeShown{6};

class Notices {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Kind = NoticesPart::Notice::Kind;

  /// The same words again, while they are shown, take the place of the first.
  void add(Kind kind, std::string words, std::optional<protocol::MapPoint> at, Time now);
  [[nodiscard]] const NoticesPart& part() const { return part_; }
  /// The number of the last one; 0 before the first.
  [[nodiscard]] std::uint64_t last() const { return last_; }
  /// Those with a place whose words are to be shown there; valid until the next change.
  [[nodiscard]] std::vector<const NoticesPart::Notice*> shown(Time now) const;
  /// When fewer are shown than now; nothing when none is.
  [[nodiscard]] std::optional<Time> due(Time now) const;

 private:
  NoticesPart part_;
  std::vector<Time> until_;  // of each
  std::uint64_t last_ = 0;
};

}  // namespace earthwork::viewer
