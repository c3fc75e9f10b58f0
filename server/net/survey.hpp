/// Asks all open maps at once how much waits in them, without making any of them wait.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "server/room/atlas.hpp"

namespace earthwork::net {

/// All maps that are open added up, each as it was when its turn came. None is opened for it.
struct MapTotals {
  std::size_t maps = 0;  ///< That there are, open or not.
  std::size_t open_maps = 0, viewers = 0, waiting_edits = 0, dirty_chunks = 0, owed_chunks = 0;
  std::int64_t oldest_wait_ms = 0;  ///< The longest of any map.

  void add(const room::RoomLoad& load);
};

/// Any thread. Held by shared_ptr: a round under way keeps it alive.
class Survey : public std::enable_shared_from_this<Survey> {
 public:
  using Told = std::function<void(const MapTotals&)>;

  /// The atlas must outlive every round.
  explicit Survey(const room::Atlas& atlas) : atlas_(atlas) {}

  /// Calls `told` once, when every open map has answered: from the strand of the last one, or at
  /// once where none is open. One round goes on at a time, whoever asks meanwhile is told its
  /// totals: so however many ask, a map has one task of it in line.
  void ask(Told told);

 private:
  void answer(const std::optional<room::RoomLoad>& load);
  void finish();

  const room::Atlas& atlas_;
  std::mutex mutex_;
  std::vector<Told> waiting_;  // empty: no round is under way
  MapTotals totals_;
  std::size_t unanswered_ = 0;
};

}  // namespace earthwork::net
