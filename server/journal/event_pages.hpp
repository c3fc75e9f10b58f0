/// The log from one seq to another, in pieces that fit into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

inline constexpr std::size_t kPageBytes = std::size_t{1} << 20;  ///< Of the log, held at a time.

using TakeEvent = std::function<protocol::Result<void>(const history::Event&)>;

/// Tells all events after seq `after` up to `up_to`, in order. Fails with what the journal fails
/// with, and with `damaged` where a number is missing: then every event before the first one that
/// cannot be had has been told. A failure that `take` returns ends it.
[[nodiscard]] protocol::Result<void> read_events(Journal& journal, std::uint64_t after,
                                                 std::uint64_t up_to, const TakeEvent& take);

}  // namespace earthwork::journal
