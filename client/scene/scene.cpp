#include "client/scene/scene.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace earthwork::scene {

using protocol::ChunkDelta;
using protocol::ChunkKey;
using protocol::ChunkMesh;
using protocol::ChunkRecord;
using protocol::Code;
using protocol::fail;
using protocol::GroupBegin;
using protocol::GroupEnd;
using protocol::Result;

namespace {

tl::unexpected<protocol::Failure> too_many_chunks() {
  return fail(Code::too_large, "more chunks than the limit of " + std::to_string(kMaxSceneChunks));
}

}  // namespace

void Scene::join(std::uint64_t epoch, std::uint64_t map_seq) {
  group_.reset();
  complete_view_.reset();
  holding_.join(epoch, map_seq);
  keep_only([this](const ChunkKey& key) { return holding_.holds(key); });
  epoch_ = epoch;
  seq_ = holding_.seq();
}

void Scene::look(std::uint32_t n, const std::optional<protocol::MapRect>& rect,
                 const protocol::MapSettings& settings) {
  last_view_ = n;
  holding_.look(n, rect, settings);
  keep_only([this](const ChunkKey& key) { return holding_.wants(key); });
}

void Scene::catch_up(std::uint32_t n, std::uint64_t seq) {
  complete_view_ = n;
  seq_ = std::max(seq_, seq);
  holding_.catch_up(n, seq);
}

Result<void> Scene::take(std::span<protocol::FrameEvent> events, std::size_t message_bytes) {
  ++stats_.frames;
  stats_.bytes += message_bytes;
  for (protocol::FrameEvent& event : events) {
    Result<void> taken;
    if (const auto* begin = std::get_if<GroupBegin>(&event))
      taken = take_begin(*begin);
    else if (const auto* end = std::get_if<GroupEnd>(&event))
      taken = take_end(*end);
    else if (const auto* delta = std::get_if<ChunkDelta>(&event))
      taken = take_delta(*delta);
    else
      taken = take_record(std::get<ChunkRecord>(event));
    if (!taken) return taken;
  }
  return {};
}

SceneChanges Scene::take_changed() {
  SceneChanges changes{.keys = {}, .all = !changed_};
  if (changed_)
    changes.keys.assign(changed_->begin(), changed_->end());
  else
    for (const auto& [key, chunk] : chunks_) changes.keys.push_back(key);
  changed_.emplace();
  return changes;
}

Result<void> Scene::take_begin(const GroupBegin& begin) {
  if (group_) return fail(Code::bad_frame, "a group begins inside a group");
  if (begin.epoch == epoch_ && begin.seq < seq_)
    return fail(Code::bad_frame, "a group goes back from seq " + std::to_string(seq_) + " to " +
                                     std::to_string(begin.seq));
  group_ = Group{.begin = begin, .records = {}};
  return {};
}

Result<void> Scene::take_record(ChunkRecord& record) {
  if (!group_) return apply(record);
  const ChunkKey key = record.key;
  group_->records.insert_or_assign(key, std::move(record));
  if (group_->records.size() > kMaxSceneChunks) return too_many_chunks();
  return {};
}

// What a delta starts from does not change before the group's end: nothing comes outside groups
// while one is open. A mesh is all that is needed, so nothing is kept beside it.
Result<void> Scene::take_delta(const ChunkDelta& delta) {
  if (!group_) return fail(Code::bad_frame, "a delta comes outside a group");
  if (!holding_.wants(delta.key)) return {};
  const ChunkMesh* base = base_of(delta);
  if (!base) {
    // Of an earlier view, it may be for a chunk that was let go since; the whole of it follows.
    if (last_view_ && group_->begin.view != *last_view_) return {};
    return fail(Code::bad_frame,
                "base revision: no mesh of " + std::to_string(delta.base_revision) + " is held",
                "base revision");
  }
  auto record = protocol::apply_delta(*base, delta);
  if (!record) return tl::unexpected<protocol::Failure>(std::move(record.error()));
  return take_record(*record);
}

const ChunkMesh* Scene::base_of(const ChunkDelta& delta) const {
  const auto pending = group_->records.find(delta.key);
  if (pending != group_->records.end()) {
    const ChunkRecord& record = pending->second;
    return !record.removed && record.revision == delta.base_revision ? &record.mesh : nullptr;
  }
  const auto held = chunks_.find(delta.key);
  if (held == chunks_.end() || group_->begin.epoch != epoch_) return nullptr;
  return held->second.revision == delta.base_revision ? &held->second.mesh : nullptr;
}

Result<void> Scene::take_end(const GroupEnd& end) {
  if (!group_) return fail(Code::bad_frame, "a group ends that did not begin");
  Group group = std::move(*group_);
  group_.reset();
  if (end.seq != group.begin.seq)
    return fail(Code::bad_frame, "a group of seq " + std::to_string(group.begin.seq) +
                                     " ends with seq " + std::to_string(end.seq));
  if (group.begin.epoch != epoch_) {
    clear();
    holding_.join(group.begin.epoch, end.seq);
  }
  for (auto& [key, record] : group.records)
    if (auto applied = apply(record); !applied) return applied;
  epoch_ = group.begin.epoch;
  seq_ = end.seq;
  holding_.reach(end.seq);
  return {};
}

Result<void> Scene::apply(ChunkRecord& record) {
  if (!holding_.wants(record.key)) return {};
  drop(record.key);
  if (record.removed) return {};
  if (chunks_.size() == kMaxSceneChunks) return too_many_chunks();
  const std::uint64_t term = protocol::mesh_hash_term(record.key, protocol::mesh_hash(record.mesh));
  put(record.key, {.revision = record.revision, .mesh = std::move(record.mesh), .hash_term = term});
  return {};
}

void Scene::put(const ChunkKey& key, SceneChunk chunk) {
  mesh_hash_ += chunk.hash_term;
  ++stats_.chunks;
  stats_.vertices += chunk.mesh.vertices.size();
  stats_.triangles += chunk.mesh.triangles.size() / 3;
  stats_.sections += chunk.mesh.sections.size();
  note(key);
  chunks_.emplace(key, std::move(chunk));
}

void Scene::drop(const ChunkKey& key) {
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return;
  note(key);
  const SceneChunk& chunk = found->second;
  mesh_hash_ -= chunk.hash_term;
  --stats_.chunks;
  stats_.vertices -= chunk.mesh.vertices.size();
  stats_.triangles -= chunk.mesh.triangles.size() / 3;
  stats_.sections -= chunk.mesh.sections.size();
  chunks_.erase(found);
}

void Scene::note(const ChunkKey& key) {
  if (!changed_) return;
  changed_->insert(key);
  if (changed_->size() > kMaxSceneChunks) changed_.reset();
}

template <class Stays>
void Scene::keep_only(const Stays& stays) {
  std::vector<ChunkKey> gone;
  for (const auto& [key, chunk] : chunks_)
    if (!stays(key)) gone.push_back(key);
  for (const ChunkKey& key : gone) drop(key);
}

void Scene::clear() {
  chunks_.clear();
  changed_.reset();
  mesh_hash_ = 0;
  stats_ = {.chunks = 0,
            .triangles = 0,
            .vertices = 0,
            .sections = 0,
            .frames = stats_.frames,
            .bytes = stats_.bytes};
}

}  // namespace earthwork::scene
