/// Which part of its map a viewer holds completely, and as of when: what it may claim when it comes
/// back after its connection was lost.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "protocol/chunk_range.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/messages.hpp"
#include "protocol/settings.hpp"

namespace earthwork::scene {

class Holding {
 public:
  /// A connection has joined. What is held stays claimed if it is of this epoch and the map, which
  /// is at `map_seq`, has got that far.
  void join(std::uint64_t epoch, std::uint64_t map_seq);
  /// View `n` is asked for: nothing outside it is wanted or held any more.
  void look(std::uint32_t n, const std::optional<protocol::MapRect>& rect,
            const protocol::MapSettings& settings);
  /// All of view `n` has arrived; of another view than the last one it means nothing.
  void catch_up(std::uint32_t n, std::uint64_t seq);
  /// A group has ended: what arrived over this connection is as of `seq`.
  void reach(std::uint64_t seq);

  /// Inside the last view; everything is before there was one.
  [[nodiscard]] bool wants(const protocol::ChunkKey& key) const;
  /// Inside what is held as of `seq` or later.
  [[nodiscard]] bool holds(const protocol::ChunkKey& key) const {
    return held_.contains(key.x, key.y);
  }
  [[nodiscard]] std::uint64_t seq() const { return seq_; }
  /// As of View; nothing when nothing is held.
  [[nodiscard]] std::optional<protocol::Have> have() const;

 private:
  std::optional<protocol::ChunkRange> wanted_;  // none: everything
  protocol::ChunkRange held_;
  std::uint64_t epoch_ = 0, seq_ = 0;
  std::uint32_t view_ = 0;
  // What is held arrived over this connection, so its groups keep it up to date. After a new join
  // that is so only once the server has looked at all that was claimed.
  bool live_ = false;
  protocol::MapSettings settings_;
};

}  // namespace earthwork::scene
