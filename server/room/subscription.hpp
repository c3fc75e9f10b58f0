/// What one viewer is still to be sent. It is owed chunks, never messages: however long it does
/// not read, what waits for it is a set of chunks of its view.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "protocol/messages.hpp"
#include "server/room/mesh_cache.hpp"
#include "server/room/round_plan.hpp"
#include "server/room/view_area.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// What a parcel is composed from: a map's meshes as of `seq`, as far as they are made.
struct MapState {
  const MeshCache& meshes;
  std::uint64_t epoch, seq;
};

/// When a group without a chunk is worth sending.
enum class Beat { wait, due };

class Subscription {
 public:
  /// Looks at another part of the map. What was sent of it before and is still inside counts as
  /// sent; so does what `view.have` truthfully claims. What is outside is forgotten.
  void look(const protocol::View& view, const protocol::MapSettings& settings,
            const MapState& state);

  /// These chunks' cells changed.
  void owe(std::span<const voxel::ChunkKey> dirty);

  /// What must be meshed before anything can be composed.
  void plan_owed(RoundPlan& plan) const;
  /// What is to be meshed for the next few chunks of a first load.
  void plan_first_load(RoundPlan& plan) const;

  /// All that is owed, as one group, and the next few chunks of a first load, nearest to the
  /// view's middle first, up to one that is not made yet. Empty when there is nothing to say now,
  /// and while anything owed is not made: so neighbours never come apart.
  [[nodiscard]] Parcel compose(const MapState& state, Beat beat);

  /// Something would be composed, were it made.
  [[nodiscard]] bool waiting() const { return looks_ && (!owed_.empty() || !caught_up_); }
  /// The viewer was told of an earlier seq than this one.
  [[nodiscard]] bool behind(std::uint64_t seq) const { return looks_ && told_seq_ < seq; }
  [[nodiscard]] std::size_t owed_chunks() const { return owed_.size() + unseen_.size(); }

 private:
  using Ranked = std::pair<std::uint64_t, voxel::ChunkKey>;  // by distance
  struct Claim {
    ViewArea area;
    std::uint64_t seq = 0;
  };

  [[nodiscard]] Ranked ranked(const voxel::ChunkKey& key) const {
    return {area_.distance(key), key};
  }
  std::vector<voxel::ChunkKey> candidates(const ViewArea& area, const MeshCache& meshes) const;
  void take_claim(const protocol::View& view, const protocol::MapSettings& settings,
                  const MapState& state);
  bool owes_stale(const MeshCache& meshes) const;
  std::vector<RecordBytes> take_owed(const MapState& state);
  std::vector<RecordBytes> take_unseen(const MapState& state);
  bool already_has(const voxel::ChunkKey& key, const CachedMesh& cached) const;
  const RecordBytes& record_for(const voxel::ChunkKey& key, const CachedMesh& cached);

  bool looks_ = false;
  std::uint32_t view_ = 0;
  ViewArea area_;
  std::optional<Claim> claim_;
  std::size_t layers_ = 1;
  std::set<Ranked> unseen_;            // of the view, not sent yet
  std::set<voxel::ChunkKey> owed_;     // sent before, or known to be nothing, and different now
  std::set<voxel::ChunkKey> claimed_;  // of the view, held by the viewer's word, not sent
  bool caught_up_ = false;             // was said of this view
  std::uint64_t complete_seq_ = 0;     // what was sent is as of this seq, but for what is owed
  std::uint64_t told_seq_ = 0;         // the last seq that a group or caught_up carried
};

}  // namespace earthwork::room
