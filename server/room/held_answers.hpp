/// The answers to one viewer's edits, from when they are decided on until what they say is durable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "protocol/result.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// One thread at a time.
class HeldAnswers {
 public:
  /// Is true once event `seq` is durable, and said after all that were added before.
  void add(Reply reply, std::uint64_t seq);
  /// Takes out those that can be said, in order.
  [[nodiscard]] std::vector<Reply> take(std::uint64_t durable_seq);
  /// Whatever is not durable never will be: its edit is refused, for this.
  void refuse(std::uint64_t durable_seq, const protocol::Failure& why);

 private:
  std::vector<Reply> replies_;
  std::vector<std::uint64_t> seqs_;  // of replies_
};

}  // namespace earthwork::room
