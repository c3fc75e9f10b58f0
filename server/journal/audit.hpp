/// Whether a journal's parts agree with each other: the log executed again, from its start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

inline constexpr std::size_t kMaxFindings = 100;

struct Audit {
  std::uint64_t events = 0;     ///< Executed, every stored hash agreeing: the log is good up to it.
  std::uint64_t hash = 0;       ///< Of the map after them.
  std::uint64_t keyframes = 0;  ///< That agree with the map as of their seqs.
  /// What is damaged, by table and seq, the first kMaxFindings. The log is not executed past its
  /// first one, so keyframes and authors are compared up to there.
  std::vector<protocol::Failure> findings;
  [[nodiscard]] bool sound() const { return findings.empty(); }
};

/// Executes the log and compares every hash. At each keyframe compares its hash and each chunk's
/// state and age with the executed map. Compares what was put of each author with what the log
/// tells. Fails only when the journal cannot be read now. Holds one map, what was put of authors,
/// and kPageBytes of the log.
[[nodiscard]] protocol::Result<Audit> audit(Journal& journal);

}  // namespace earthwork::journal
