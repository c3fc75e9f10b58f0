/// Compares what was put of authors with what the log tells of them.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "server/history/event.hpp"
#include "server/journal/author_book.hpp"
#include "server/journal/findings.hpp"

namespace earthwork::journal {

/// Each author was put as of some seq: that of the last event that is told of it. It is compared
/// when the log has come there, so that no more than what is remembered has to be held.
class AuthorCheck {
 public:
  explicit AuthorCheck(std::vector<AuthorState> put);

  /// The log has come to `event`, which is in `book`.
  void executed(const history::Event& event, const AuthorBook& book, Findings& findings);
  /// The log has come to the newest keyframe, with which everybody is known.
  void at_keyframe(std::uint64_t seq, const AuthorBook& book, Findings& findings) const;
  /// The log ends, or is damaged, after `seq`: nothing up to there may be known that it had not.
  void at_end(std::uint64_t seq, Findings& findings) const;

 private:
  struct Put {
    std::vector<AuthorState::Applied> applied;  // not empty
    bool met = false;                           // the log has come to the last of them
  };
  std::map<std::uint64_t, Put> put_;
};

}  // namespace earthwork::journal
