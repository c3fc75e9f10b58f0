/// What was applied for whom, by the ids that the authors gave: so that an edit that is sent again
/// is answered again, and not applied again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::room {

/// Of each author the last protocol::kMaxRememberedIds, 16 bytes each. An author is kept as long
/// as the map is, as its events are. One thread at a time.
class Authors {
 public:
  enum class Standing {
    fresh,         ///< Larger than all that was applied: it is to be applied.
    repeated,      ///< It was applied, and has a seq.
    out_of_order,  ///< It was not applied, and a larger one was.
    too_old,       ///< Below all that are remembered, and there may have been more.
  };
  struct Verdict {
    Standing standing = Standing::fresh;
    std::uint64_t seq = 0;  ///< Of a repeated one.
    friend bool operator==(const Verdict&, const Verdict&) = default;
  };

  /// Nobody has done anything.
  Authors() = default;
  /// As it was left. Each author once; of one with more ids than are remembered the last ones.
  explicit Authors(std::span<const journal::AuthorState> states);

  [[nodiscard]] Verdict judge(std::uint64_t author, protocol::MessageId id) const;
  /// A fresh one was applied, and has this seq now: above all that were told before.
  void applied(std::uint64_t author, protocol::MessageId id, std::uint64_t seq);
  /// What is remembered of this author, which may be nothing.
  [[nodiscard]] journal::AuthorState state(std::uint64_t author) const;

  /// What was applied up to `seq` stays.
  void keep(std::uint64_t seq);
  /// Nothing was applied but what stays, and what was forgotten for the rest is remembered again.
  void take_back();

 private:
  using Applied = journal::AuthorState::Applied;
  // A ring once it is full; then `oldest` is where the next one goes. Ids increase from there on.
  struct Memory {
    std::vector<Applied> ring;
    std::size_t oldest = 0;

    [[nodiscard]] const Applied& nth(std::size_t n) const {
      return ring[(oldest + n) % ring.size()];
    }
    [[nodiscard]] std::optional<Applied> add(const Applied& applied);
    void undo(const std::optional<Applied>& forgotten);
  };
  struct Tentative {
    std::uint64_t author = 0, seq = 0;
    std::optional<Applied> forgotten;  // for it
  };

  std::unordered_map<std::uint64_t, Memory> memories_;  // none empty
  std::deque<Tentative> tentative_;                     // by seq
};

}  // namespace earthwork::room
