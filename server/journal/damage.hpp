/// How damage is told to people: with the file, the table and the seq that it was found at.
#pragma once

#include <cstdint>
#include <string_view>

#include "protocol/result.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// `damaged`, "FILE: TABLE: seq N: SENTENCE"; without what is empty, or 0.
[[nodiscard]] tl::unexpected<protocol::Failure> damage(std::string_view file,
                                                       std::string_view table, std::uint64_t seq,
                                                       std::string_view sentence);

/// What Execution::apply says of an event of this journal's.
[[nodiscard]] protocol::Failure in_events_of(const Journal& journal, protocol::Failure failure);

}  // namespace earthwork::journal
