/// Which keyframes are worth their room: the newest, from which a start goes on, and enough older
/// ones that a look at any past state executes few events.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace earthwork::journal {

/// A past state is reached from a kept keyframe, or the empty map, through fewer events than this.
inline constexpr std::uint64_t kKeyframeSpacing = 65'536;

/// Of these seqs, which increase, those that are kept; they increase too. What is kept beside the
/// newest is kept whatever comes later, so that a state is superseded once and for all.
[[nodiscard]] inline std::vector<std::uint64_t> kept_keyframes(
    std::span<const std::uint64_t> seqs) {
  std::vector<std::uint64_t> kept;
  std::uint64_t last = 0;
  for (const std::uint64_t seq : seqs) {
    if (seq - last < kKeyframeSpacing && seq != seqs.back()) continue;
    kept.push_back(seq);
    last = seq;
  }
  return kept;
}

}  // namespace earthwork::journal
