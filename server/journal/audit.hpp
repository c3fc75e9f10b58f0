/// Whether a journal's parts agree with each other: the log executed again, from its start.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

struct Audit {
  std::uint64_t events = 0;                 ///< Executed, every stored hash agreeing.
  std::uint64_t hash = 0;                   ///< Of the map after them.
  std::uint64_t keyframes = 0;              ///< That agree with the map as of their seqs.
  std::vector<protocol::Failure> findings;  ///< What is damaged; the log's first one ends it.
  [[nodiscard]] bool sound() const { return findings.empty(); }
};

/// Executes the log and compares every hash; compares each keyframe's chunks and the authors with
/// it. Fails only when the journal cannot be read now. Holds one map.
[[nodiscard]] protocol::Result<Audit> audit(Journal& journal);

}  // namespace earthwork::journal
