/// Shows a map to its viewers: who looks where, what each is still to be sent, and the meshes that
/// it is sent from.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/room/mesh_cache.hpp"
#include "server/room/subscription.hpp"
#include "server/room/viewer.hpp"
#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// Given when a viewer joins; never used twice in one room.
using ViewerId = std::uint64_t;

/// On the strand of the room whose part it is.
class Publisher {
 public:
  /// Runs a task on that strand after a delay, or not at all when the room is gone by then.
  using Later = std::function<void(std::chrono::milliseconds delay, std::function<void()> task)>;

  /// `map` is empty, has these settings and outlives the publisher.
  Publisher(const voxel::Map& map, const protocol::MapSettings& settings, std::uint64_t epoch,
            Later later);

  /// Who enters looks at nothing yet. `viewer` stays until it leaves.
  void enter(ViewerId id, Viewer& viewer);
  /// After it the viewer is not called again, and is nobody here.
  void leave(ViewerId id);
  void leave_all() { shows_.clear(); }

  /// Changes what the viewer is shown; parcels follow later, never from within the call. Fails
  /// with too_large for more than kMaxViewChunks. Nothing happens for nobody.
  [[nodiscard]] protocol::Result<void> look(ViewerId id, const protocol::View& view);
  /// The viewer takes the next parcel: from within the call, if there is one.
  void ready(ViewerId id);

  /// The map was changed so by its latest edit.
  void changed(const voxel::Change& change);
  /// Every change up to `seq` was told: delivers what the viewers who are ready are to be sent.
  void show(std::uint64_t seq);

  /// Brings up to `budget` chunks' meshes up to date; true when all are.
  [[nodiscard]] bool refresh(std::size_t budget) { return meshes_.refresh(map_, seq_, budget); }
  [[nodiscard]] const MeshTotals& totals() const { return meshes_.totals(); }
  [[nodiscard]] std::vector<RecordBytes> records() const { return meshes_.records(); }

  /// Chunks that wait to be sent, of all viewers together.
  [[nodiscard]] std::size_t owed_chunks() const;
  /// Chunks whose meshes are not up to date.
  [[nodiscard]] std::size_t dirty_chunks() const { return meshes_.stale_count(); }

 private:
  struct Show {
    Viewer* viewer = nullptr;
    Subscription subscription;
    bool ready = true;  // to take a parcel
  };

  void publish(Beat beat);
  void publish_to(Show& show, Beat beat);
  void publish_soon();
  void schedule_beat();
  [[nodiscard]] MapState state() { return {map_, meshes_, epoch_, seq_}; }

  const voxel::Map& map_;
  const protocol::MapSettings settings_;
  const std::uint64_t epoch_;
  const Later later_;

  MeshCache meshes_;
  std::uint64_t seq_ = 0;
  std::vector<voxel::ChunkKey> dirty_;  // since the last show, not in order
  std::map<ViewerId, Show> shows_;
  bool publish_scheduled_ = false, beat_scheduled_ = false;
};

}  // namespace earthwork::room
