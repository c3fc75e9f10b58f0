/// A map file's log: the tables events and batches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "server/history/event.hpp"
#include "server/journal/database.hpp"

namespace earthwork::journal {

/// Adds a batch, one event or more, within a transaction. Fails with bad_state when the last seq is
/// not `expected_seq`.
[[nodiscard]] protocol::Result<void> append_batch(Database& database, std::uint64_t expected_seq,
                                                  std::span<const history::Event> events);

/// Of the last event; 0 without one.
[[nodiscard]] protocol::Result<std::uint64_t> last_event_seq(Database& database);
/// Of the last batch; 0 without one.
[[nodiscard]] protocol::Result<std::uint64_t> last_batch_seq(Database& database);
/// The map's hash after an event; nothing when there is no such event.
[[nodiscard]] protocol::Result<std::optional<std::uint64_t>> event_hash(Database& database,
                                                                        std::uint64_t seq);

/// As Journal::events; whole batches are read and their sums compared. Damage behind what could be
/// read is left to the call that begins there.
[[nodiscard]] protocol::Result<std::vector<history::Event>> read_log(Database& database,
                                                                     std::uint64_t from_seq,
                                                                     std::size_t most_bytes);

/// That events 1 to `last` are all there, in batches whose sums are right. What the commands say is
/// not looked at.
[[nodiscard]] protocol::Result<void> check_log(Database& database, std::uint64_t last);

/// Removes all events after `seq`, within a transaction; what is left of a batch becomes one.
[[nodiscard]] protocol::Result<void> cut_log(Database& database, std::uint64_t seq);

}  // namespace earthwork::journal
