/// What was applied for whom, by the ids that the authors gave: so that an edit that is sent again
/// is answered again, and not applied again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

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

  [[nodiscard]] Verdict judge(std::uint64_t author, protocol::MessageId id) const;
  /// A fresh one was applied, and has this seq now.
  void applied(std::uint64_t author, protocol::MessageId id, std::uint64_t seq);

 private:
  struct Applied {
    protocol::MessageId id = 0;
    std::uint64_t seq = 0;
  };
  // A ring once it is full; then `oldest` is where the next one goes. Ids increase from there on.
  struct Memory {
    std::vector<Applied> ring;
    std::size_t oldest = 0;

    [[nodiscard]] const Applied& nth(std::size_t n) const {
      return ring[(oldest + n) % ring.size()];
    }
  };

  std::unordered_map<std::uint64_t, Memory> memories_;
};

}  // namespace earthwork::room
