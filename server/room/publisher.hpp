/// Shows a map to its viewers: who looks where, what each is still to be sent, and the meshes that
/// it is sent from.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/journal/chunk_ages.hpp"
#include "server/room/mesh_cache.hpp"
#include "server/room/mesh_maker.hpp"
#include "server/room/mesh_round.hpp"
#include "server/room/meters.hpp"
#include "server/room/round_plan.hpp"
#include "server/room/subscription.hpp"
#include "server/room/viewer.hpp"
#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

inline constexpr std::chrono::microseconds kRestPerViewer{40};
/// Twenty times a second everybody is shown something, however many there are.
inline constexpr std::chrono::milliseconds kLongestRest{50};

/// Meshes are made in rounds: all that viewers who are ready wait for, as of the seq that is shown,
/// which then stays until the round is over. A small round is made at once; a larger one on the
/// thread pool, while the map goes on. So what is shown is behind the map by a round or a rest, is
/// consistent at any time, and no round is ever made in vain.
///
/// Nothing is delivered before the seq that is shown is durable, and nothing newer is taken in
/// before that was delivered: meshes are made while a commit is under way, and every commit brings
/// everybody further. When edits are taken back, so are the meshes that nobody was sent.
///
/// The more viewers there are, the more edits they are shown at a time: after something was shown,
/// what is new rests for kRestPerViewer for each of them, so that a crowd costs a part of a core
/// and not all of it. Few viewers are shown every turn, and what comes after a rest at once.
///
/// On the strand of the room whose part it is.
class Publisher {
 public:
  /// What is shown. The map and its settings outlive the publisher, and change between calls
  /// only. It begins as of `seq`, which is durable; `ages` are of its chunks and those that
  /// are gone.
  struct Subject {
    const voxel::Map& map;
    const protocol::MapSettings& settings;
    std::uint64_t epoch;
    std::uint64_t seq;
    std::span<const journal::ChunkAge> ages;
    std::shared_ptr<Meters> meters;
  };
  /// Runs a task on that strand after a delay, or not at all when the room is gone by then.
  using Later = std::function<void(std::chrono::milliseconds delay, std::function<void()> task)>;

  /// `workplace` is called on the strand, for each round.
  Publisher(Subject subject, Later later, std::function<Workplace()> workplace);

  /// Who enters looks at nothing yet. `viewer` stays until it leaves.
  void enter(ViewerId id, Viewer& viewer);
  /// After it the viewer is not called again, and is nobody here.
  void leave(ViewerId id);
  void leave_all() { shows_.clear(); }

  /// Changes what the viewer is shown; parcels follow later, never from within the call. Of views
  /// that come faster than they can be taken up the last one counts. Fails with too_large for more
  /// than kMaxViewChunks. Nothing happens for nobody.
  [[nodiscard]] protocol::Result<void> look(ViewerId id, const protocol::View& view);
  /// The viewer takes the next parcel: from within the call, if there is one.
  void ready(ViewerId id);

  /// The map was changed so by its latest event, `seq`.
  void changed(const voxel::Change& change, std::uint64_t seq);
  /// All events up to `seq` are durable: delivers what has waited for that.
  void durable(std::uint64_t seq);
  /// Every change was told: delivers what the viewers who are ready are to be sent, now or when the
  /// round that runs is over, or the rest, or what was shown before is durable.
  void show();
  /// The map is again what it was after the last durable event.
  void taken_back();

  /// Brings up to `budget` chunks' meshes up to date with the map, or a few more; true when all
  /// are. May deliver parcels. When it has gone on over something that waits to be durable, it does
  /// so again only after that was delivered, and until then gives false.
  [[nodiscard]] bool refresh(std::size_t budget);
  /// As of the map's latest edit when `refresh` gave true in the same task.
  [[nodiscard]] const MeshTotals& totals() const { return meshes_.totals(); }
  [[nodiscard]] std::vector<RecordBytes> records() const { return meshes_.records(); }

  /// Chunks that wait to be sent, of all viewers together.
  [[nodiscard]] std::size_t owed_chunks() const;
  /// Chunks that changed since their meshes were made.
  [[nodiscard]] std::size_t dirty_chunks() const { return meshes_.dirty_count() + pending_.size(); }

 private:
  struct Show {
    Viewer* viewer = nullptr;
    Subscription subscription;
    std::optional<protocol::View> wanted;  // asked for, and not taken up yet
    bool ready = true;                     // to take a parcel
    std::uint64_t sent_seq = 0;            // of the last one
  };

  [[nodiscard]] bool shown_is_durable() const { return seq_ <= durable_; }
  std::size_t take_up_a_view();
  void take_up_views();
  void go_on();
  /// No mesh can be made now of what is shown: a round makes them, or the map has gone on and what
  /// is new waits.
  [[nodiscard]] bool held() const { return round_ || latest_ != seq_; }
  void rest();
  void take_in_pending();
  /// How many chunks the map has or may have meshes of, those included that are not taken in yet.
  [[nodiscard]] std::size_t chunks_to_show() const;
  [[nodiscard]] bool plans_for(const Show& show) const;
  [[nodiscard]] RoundPlan plan_for_all();
  void make(const std::vector<voxel::ChunkKey>& keys);
  void make_here(std::span<const voxel::ChunkKey> keys);
  void start_round(std::span<const voxel::ChunkKey> keys);
  void remember(std::span<const voxel::ChunkKey> keys);
  void end_round();
  void publish(Beat beat);
  void publish_to(Show& show, Beat beat);
  void publish_soon();
  void schedule_beat();
  [[nodiscard]] MapState state() const { return {meshes_, epoch_, seq_}; }

  const voxel::Map& map_;
  const protocol::MapSettings& settings_;
  const std::uint64_t epoch_;
  const std::shared_ptr<Meters> meters_;
  const Later later_;
  const std::function<Workplace()> workplace_;

  using Before = std::unordered_map<voxel::ChunkKey, Forerunner, voxel::ChunkKeyHash>;

  MeshCache meshes_;          // as of seq_,
  std::uint64_t seq_ = 0;     // which is shown, as far as meshes are made and it is durable
  std::uint64_t latest_ = 0;  // the map's: ahead of seq_ while what is new waits
  std::uint64_t durable_ = 0;
  std::uint64_t delivered_ = 0;  // while seq_ is not durable: the one before it, which is;
  Before before_;                // and of all that is different, made or stale since, what was then
  bool overtaken_ = false;       // `refresh` has gone on over one since then, undelivered
  std::unordered_set<voxel::ChunkKey, voxel::ChunkKeyHash> pending_;  // not taken in yet
  std::shared_ptr<MeshRound> round_;                                  // that runs
  MeshMaker maker_;                                                   // the strand's
  MeshRound::Makers makers_;                                          // for rounds, when none runs
  std::map<ViewerId, Show> shows_;
  std::deque<ViewerId> lookers_;  // whose views are wanted; one is taken up at a time
  ViewerId last_loader_ = 0;      // whose first load was the last in a plan
  bool publish_scheduled_ = false, beat_scheduled_ = false;
  bool beat_waits_ = false;  // for what is shown to be durable
  bool resting_ = false;     // what is new is not taken in yet
};

}  // namespace earthwork::room
