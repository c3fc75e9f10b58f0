/// Compares a keyframe with the map that the log gave as of its seq.
#pragma once

#include "server/journal/execution.hpp"
#include "server/journal/findings.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// Its hash; every chunk's state and age; that no chunk is missing. True when all agree. Fails with
/// what the journal fails with, but for damage, which is found.
[[nodiscard]] protocol::Result<bool> check_keyframe(Journal& journal, const Keyframe& keyframe,
                                                    const Execution& executed, Findings& findings);

}  // namespace earthwork::journal
