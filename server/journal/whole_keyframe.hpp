/// A keyframe of a map that nobody paints on meanwhile, put in one go.
#pragma once

#include <cstdint>

#include "server/journal/execution.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// Puts all chunks that changed since the journal's newest keyframe, all authors, and the keyframe.
/// `executed` is as of the journal's last seq. Does nothing when there is a keyframe of it already.
[[nodiscard]] protocol::Result<void> put_whole_keyframe(Journal& journal, const Execution& executed,
                                                        std::int64_t time_ms);

}  // namespace earthwork::journal
