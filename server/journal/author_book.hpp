/// What is to be remembered of each author, written down while a log is read.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// Of each author the last protocol::kMaxRememberedIds.
class AuthorBook {
 public:
  AuthorBook() = default;
  /// What `known` says of events up to `up_to`.
  AuthorBook(std::vector<AuthorState> known, std::uint64_t up_to);

  /// Adds the author's next one. False, and nothing is added, when its id or its seq is not above
  /// the last one's, or 0, or when its id is above protocol::kMaxInteger.
  [[nodiscard]] bool add(std::uint64_t author, const AuthorState::Applied& applied);
  /// Empty for an author who is not known. Valid until the next `add`.
  [[nodiscard]] std::span<const AuthorState::Applied> of(std::uint64_t author) const;
  /// Everybody, in order of the authors.
  [[nodiscard]] std::vector<AuthorState> states() const;

 private:
  // Holds up to twice what is remembered, so that forgetting is rare.
  std::unordered_map<std::uint64_t, std::vector<AuthorState::Applied>> pages_;
};

}  // namespace earthwork::journal
