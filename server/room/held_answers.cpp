#include "server/room/held_answers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

namespace earthwork::room {

void HeldAnswers::add(Reply reply, std::uint64_t seq) {
  replies_.push_back(std::move(reply));
  seqs_.push_back(seq);
}

std::vector<Reply> HeldAnswers::take(std::uint64_t durable_seq) {
  const auto end = std::find_if(seqs_.begin(), seqs_.end(),
                                [&](std::uint64_t seq) { return seq > durable_seq; });
  if (end == seqs_.end()) {
    seqs_.clear();
    return std::exchange(replies_, {});
  }
  const auto replies_end = std::next(replies_.begin(), std::distance(seqs_.begin(), end));
  std::vector<Reply> taken(std::move_iterator(replies_.begin()), std::move_iterator(replies_end));
  replies_.erase(replies_.begin(), replies_end);
  seqs_.erase(seqs_.begin(), end);
  return taken;
}

void HeldAnswers::refuse(std::uint64_t durable_seq, const protocol::Failure& why) {
  for (std::size_t i = 0; i < seqs_.size(); ++i) {
    if (seqs_[i] <= durable_seq) continue;
    const auto id =
        std::visit([](const auto& reply) -> std::optional<protocol::MessageId> { return reply.id; },
                   replies_[i]);
    replies_[i] = protocol::Rejected{.id = id, .failure = why};
    seqs_[i] = durable_seq;
  }
}

}  // namespace earthwork::room
