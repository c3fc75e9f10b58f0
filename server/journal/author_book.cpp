#include "server/journal/author_book.hpp"

#include <algorithm>

#include "protocol/limits.hpp"

namespace earthwork::journal {

using protocol::kMaxRememberedIds;

AuthorBook::AuthorBook(std::vector<AuthorState> known, std::uint64_t up_to) {
  for (AuthorState& state : known) {
    std::erase_if(state.applied, [up_to](const auto& applied) { return applied.seq > up_to; });
    if (!state.applied.empty()) pages_.emplace(state.author, std::move(state.applied));
  }
}

bool AuthorBook::add(std::uint64_t author, const AuthorState::Applied& applied) {
  const auto known = of(author);
  const AuthorState::Applied last = known.empty() ? AuthorState::Applied{} : known.back();
  if (applied.id <= last.id || applied.seq <= last.seq || applied.id > protocol::kMaxInteger)
    return false;
  auto& page = pages_[author];
  if (page.size() >= 2 * kMaxRememberedIds)
    page.erase(page.begin(), page.end() - (kMaxRememberedIds - 1));
  page.push_back(applied);
  return true;
}

std::span<const AuthorState::Applied> AuthorBook::of(std::uint64_t author) const {
  const auto found = pages_.find(author);
  if (found == pages_.end()) return {};
  const std::span<const AuthorState::Applied> page(found->second);
  return page.last(std::min(page.size(), kMaxRememberedIds));
}

std::vector<AuthorState> AuthorBook::states() const {
  std::vector<AuthorState> states;
  states.reserve(pages_.size());
  for (const auto& [author, page] : pages_) {
    const auto last = of(author);
    states.push_back({author, {last.begin(), last.end()}});
  }
  std::ranges::sort(states, {}, &AuthorState::author);
  return states;
}

}  // namespace earthwork::journal
