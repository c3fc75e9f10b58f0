/// The edits that a client has made and the server has not answered, changes of layers too: kept,
/// so that they can be sent again over another connection.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::link {

/// As many as a server remembers: what is sent again is never too old for it.
inline constexpr std::size_t kMaxUnansweredEdits = protocol::kMaxRememberedIds;
inline constexpr std::size_t kMaxUnansweredBytes = 2 * 1024 * 1024;

class Unanswered {
 public:
  /// In order of their ids.
  using Edits = std::map<protocol::MessageId, std::string>;

  /// The first edit gets an id larger than `last_id`.
  explicit Unanswered(protocol::MessageId last_id = 0) : last_id_(last_id) {}

  struct Kept {
    protocol::MessageId id = 0;
    std::string_view message;  ///< Valid until the edit is answered.
  };
  /// Gives the edit the next id and keeps the message that says it.
  /// Fails with too_large, and uses no id, when the message is longer than kMaxControlBytes or more
  /// would wait than the two bounds allow.
  [[nodiscard]] protocol::Result<Kept> add(const protocol::Edit& edit);
  [[nodiscard]] protocol::Result<Kept> add(const protocol::LayerChange& change);
  /// It was answered: forgets it. False when it did not wait.
  [[nodiscard]] bool answer(protocol::MessageId id);
  /// Forgets all, and says which they were, in order.
  [[nodiscard]] std::vector<protocol::MessageId> give_up();

  [[nodiscard]] const Edits& edits() const { return edits_; }
  /// Another edit might be refused.
  [[nodiscard]] bool full() const;

 private:
  protocol::Result<Kept> keep(const protocol::ClientMessage& message);

  Edits edits_;
  std::size_t bytes_ = 0;
  protocol::MessageId last_id_;
};

}  // namespace earthwork::link
