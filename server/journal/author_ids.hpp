/// What is remembered of an author, as few bytes.
///
/// For each id, in order: how much it is above the one before (0 before the first), then the same
/// of its event's seq. Both are above 0, and each is 7 bits a byte, low ones first, with bit 7 set
/// in all bytes but the last, which is not 0. Ids 5 and 6 of events 300 and 301 are 05 AC 02, 01
/// 01.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

[[nodiscard]] std::string encode_ids(std::span<const AuthorState::Applied> applied);

/// Nothing unless the bytes are what encode_ids makes of at most kMaxRememberedIds ids, each at
/// most kMaxInteger like their seqs. Reads bytes of anybody.
[[nodiscard]] std::optional<std::vector<AuthorState::Applied>> decode_ids(
    std::span<const std::byte> bytes);

}  // namespace earthwork::journal
