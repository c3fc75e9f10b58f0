#include "server/room/subscription.hpp"

#include <algorithm>

namespace earthwork::room {
namespace {

// A parcel of a first load ends after either: so that groups get between.
constexpr std::size_t kFirstLoadBytes = 64 * 1024;
constexpr int kFirstLoadChunks = 128;
// A parcel's bytes of chunks as they are mostly: so many are meshed ahead.
constexpr int kFirstLoadMeshes = 64;

}  // namespace

std::vector<voxel::ChunkKey> Subscription::candidates(const ViewArea& area,
                                                      const MeshCache& meshes) const {
  const protocol::ChunkRange& range = area.range();
  std::vector<voxel::ChunkKey> keys;
  // Removed chunks are listed too where something is claimed: who claims to have some must hear.
  const auto wanted = [&](const voxel::ChunkKey& key) {
    return claim_ ? meshes.knows(key) : meshes.may_have_mesh(key);
  };
  if (range.count() > meshes.count()) {
    for (const voxel::ChunkKey& key : meshes.keys())
      if (area.contains(key) && wanted(key)) keys.push_back(key);
    return keys;
  }
  for (std::int32_t layer = 0; layer < static_cast<std::int32_t>(layers_); ++layer)
    for (std::int32_t x = range.x0; x < range.x1; ++x)
      for (std::int32_t y = range.y0; y < range.y1; ++y)
        if (const voxel::ChunkKey key{layer, x, y, 0}; wanted(key)) keys.push_back(key);
  return keys;
}

void Subscription::look(const protocol::View& view, const protocol::MapSettings& settings,
                        const MapState& state) {
  const ViewArea before = area_;
  const std::set<Ranked> unseen_before = std::move(unseen_);

  area_ = ViewArea(view.rect, settings);
  layers_ = settings.layers.size();
  take_claim(view, settings, state);

  std::vector<Ranked> unseen;
  for (const voxel::ChunkKey& key : candidates(area_, state.meshes))
    if (!before.contains(key) || unseen_before.contains({before.distance(key), key}))
      unseen.push_back(ranked(key));
  std::sort(unseen.begin(), unseen.end());
  unseen_ = std::set<Ranked>(unseen.begin(), unseen.end());
  for (auto* keys : {&owed_, &claimed_})
    std::erase_if(*keys, [&](const voxel::ChunkKey& key) { return !area_.contains(key); });

  if (!looks_) complete_seq_ = state.seq;  // it has nothing yet, so nothing that is older
  looks_ = true;
  view_ = view.n;
  caught_up_ = false;
}

// What was claimed before is still held where no view has left it: until all of it was gone
// through, a chunk that was removed meanwhile must be told.
void Subscription::take_claim(const protocol::View& view, const protocol::MapSettings& settings,
                              const MapState& state) {
  if (view.have) {
    claim_.reset();
    if (view.have->epoch == protocol::hex(state.epoch) && view.have->seq <= state.seq)
      claim_ = Claim{ViewArea(view.have->rect, settings), view.have->seq};
  }
  if (claim_) claim_->area = claim_->area.cut_to(area_);
}

void Subscription::owe(std::span<const voxel::ChunkKey> dirty) {
  if (!looks_) return;
  for (const voxel::ChunkKey& key : dirty)
    if (area_.contains(key) && !unseen_.contains(ranked(key))) owed_.insert(key);
}

void Subscription::plan_owed(RoundPlan& plan) const {
  for (const voxel::ChunkKey& key : owed_) plan.add_owed(key);
}

void Subscription::plan_first_load(RoundPlan& plan) const {
  int chunks = 0, meshes = 0;
  for (auto next = unseen_.begin(); next != unseen_.end() && chunks < kFirstLoadChunks &&
                                    meshes < kFirstLoadMeshes && plan.takes_first_seen();
       ++next, ++chunks)
    meshes += plan.add_first_seen(next->second) ? 1 : 0;
}

Parcel Subscription::compose(const MapState& state, Beat beat) {
  Parcel parcel;
  if (!looks_ || owes_stale(state.meshes)) return parcel;
  parcel.group_records = take_owed(state);
  parcel.first_seen = take_unseen(state);
  complete_seq_ = state.seq;

  if (!parcel.group_records.empty() || (beat == Beat::due && told_seq_ < state.seq)) {
    parcel.group = protocol::GroupBegin{.epoch = state.epoch, .seq = state.seq, .view = view_};
    told_seq_ = state.seq;
  }
  if (unseen_.empty() && !caught_up_) {
    parcel.caught_up = protocol::CaughtUp{.n = view_, .seq = state.seq};
    caught_up_ = true;
    claim_.reset();
    told_seq_ = state.seq;
  }
  return parcel;
}

bool Subscription::owes_stale(const MeshCache& meshes) const {
  return std::any_of(owed_.begin(), owed_.end(),
                     [&](const voxel::ChunkKey& key) { return meshes.stale(key); });
}

std::vector<RecordBytes> Subscription::take_owed(const MapState& state) {
  std::vector<RecordBytes> records;
  for (const voxel::ChunkKey& key : owed_) {
    const CachedMesh* cached = state.meshes.find(key);
    if (cached && cached->revision > complete_seq_) records.push_back(record_for(key, *cached));
  }
  owed_.clear();
  return records;
}

std::vector<RecordBytes> Subscription::take_unseen(const MapState& state) {
  std::vector<RecordBytes> records;
  std::size_t bytes = 0;
  for (int chunks = 0; !unseen_.empty() && bytes < kFirstLoadBytes && chunks < kFirstLoadChunks;
       ++chunks) {
    const voxel::ChunkKey key = unseen_.begin()->second;
    if (state.meshes.stale(key)) break;
    unseen_.erase(unseen_.begin());
    const CachedMesh* cached = state.meshes.find(key);
    if (!cached) continue;
    if (already_has(key, *cached)) {
      if (!cached->removed) claimed_.insert(key);
      continue;
    }
    claimed_.erase(key);
    records.push_back(cached->bytes);
    bytes += cached->bytes->size();
  }
  return records;
}

// What is neither owed nor unseen is held in its latest revision up to complete_seq_. So the delta
// fits where its base is that one; but none starts from a mesh that was only claimed.
const RecordBytes& Subscription::record_for(const voxel::ChunkKey& key, const CachedMesh& cached) {
  const bool claimed = claimed_.erase(key) != 0;
  const bool fits = cached.delta && cached.base_revision <= complete_seq_ && !claimed;
  return fits ? cached.delta : cached.bytes;
}

bool Subscription::already_has(const voxel::ChunkKey& key, const CachedMesh& cached) const {
  const bool claimed = claim_ && claim_->area.contains(key);
  return claimed ? cached.revision <= claim_->seq : cached.removed;
}

}  // namespace earthwork::room
