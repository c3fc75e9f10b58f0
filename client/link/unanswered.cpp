#include "client/link/unanswered.hpp"

#include <utility>

namespace earthwork::link {

using protocol::Code;
using protocol::MessageId;

protocol::Result<Unanswered::Kept> Unanswered::add(const protocol::Edit& edit) {
  return keep(protocol::EditMessage{.id = last_id_ + 1, .edit = edit});
}

protocol::Result<Unanswered::Kept> Unanswered::add(const protocol::LayerChange& change) {
  return keep(protocol::LayerMessage{.id = last_id_ + 1, .change = change});
}

protocol::Result<Unanswered::Kept> Unanswered::keep(const protocol::ClientMessage& message) {
  const MessageId id = last_id_ + 1;
  std::string text = protocol::write(message);
  if (text.size() > protocol::kMaxControlBytes)
    return protocol::fail(Code::too_large, "a message of " + std::to_string(text.size()) +
                                               " bytes is beyond the limit of " +
                                               std::to_string(protocol::kMaxControlBytes));
  if (edits_.size() >= kMaxUnansweredEdits || bytes_ + text.size() > kMaxUnansweredBytes)
    return protocol::fail(Code::too_large, "edits wait that are beyond the limit of " +
                                               std::to_string(kMaxUnansweredEdits) + " or of " +
                                               std::to_string(kMaxUnansweredBytes) + " bytes");
  last_id_ = id;
  bytes_ += text.size();
  const auto kept = edits_.emplace_hint(edits_.end(), id, std::move(text));
  return Kept{.id = id, .message = kept->second};
}

bool Unanswered::answer(MessageId id) {
  const auto found = edits_.find(id);
  if (found == edits_.end()) return false;
  bytes_ -= found->second.size();
  edits_.erase(found);
  return true;
}

std::vector<MessageId> Unanswered::give_up() {
  std::vector<MessageId> ids;
  for (const auto& [id, text] : edits_) ids.push_back(id);
  edits_.clear();
  bytes_ = 0;
  return ids;
}

bool Unanswered::full() const {
  return edits_.size() >= kMaxUnansweredEdits ||
         bytes_ + protocol::kMaxControlBytes > kMaxUnansweredBytes;
}

}  // namespace earthwork::link
