#include "server/journal/author_check.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/chunk_record.hpp"

namespace earthwork::journal {

AuthorCheck::AuthorCheck(std::vector<AuthorState> put) {
  for (AuthorState& state : put)
    if (!state.applied.empty()) put_[state.author].applied = std::move(state.applied);
}

void AuthorCheck::executed(const history::Event& event, const AuthorBook& book,
                           Findings& findings) {
  const auto found = put_.find(event.author);
  if (found == put_.end() || found->second.applied.back().seq != event.seq) return;
  found->second.met = true;
  if (!std::ranges::equal(found->second.applied, book.of(event.author)))
    findings.add("authors", event.seq,
                 "the ids of author " + protocol::hex(event.author) +
                     " up to there are not what the log gives");
}

void AuthorCheck::at_keyframe(std::uint64_t seq, const AuthorBook& book, Findings& findings) const {
  for (const AuthorState& state : book.states()) {
    const std::uint64_t last = state.applied.back().seq;
    const auto found = put_.find(state.author);
    if (found == put_.end() || found->second.applied.back().seq < last)
      findings.add("authors", last,
                   "author " + protocol::hex(state.author) + " lacks an id that keyframe " +
                       std::to_string(seq) + " should have");
  }
}

void AuthorCheck::at_end(std::uint64_t seq, Findings& findings) const {
  for (const auto& [author, put] : put_) {
    if (put.met || put.applied.back().seq > seq) continue;
    findings.add("authors", put.applied.back().seq,
                 "the log has no such event of author " + protocol::hex(author));
  }
}

}  // namespace earthwork::journal
