#include "client/scene/scene.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace earthwork::scene {

using protocol::ChunkKey;
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

void Scene::join(std::uint64_t epoch) {
  group_.reset();
  complete_view_.reset();
  if (epoch == epoch_) return;
  clear();
  epoch_ = epoch;
  seq_ = 0;
}

void Scene::catch_up(std::uint32_t n, std::uint64_t seq) {
  complete_view_ = n;
  seq_ = std::max(seq_, seq);
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
    else
      taken = take_record(std::get<ChunkRecord>(event));
    if (!taken) return taken;
  }
  return {};
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

Result<void> Scene::take_end(const GroupEnd& end) {
  if (!group_) return fail(Code::bad_frame, "a group ends that did not begin");
  Group group = std::move(*group_);
  group_.reset();
  if (end.seq != group.begin.seq)
    return fail(Code::bad_frame, "a group of seq " + std::to_string(group.begin.seq) +
                                     " ends with seq " + std::to_string(end.seq));
  if (group.begin.epoch != epoch_) clear();
  for (auto& [key, record] : group.records)
    if (auto applied = apply(record); !applied) return applied;
  epoch_ = group.begin.epoch;
  seq_ = end.seq;
  return {};
}

Result<void> Scene::apply(ChunkRecord& record) {
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
  chunks_.emplace(key, std::move(chunk));
}

void Scene::drop(const ChunkKey& key) {
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return;
  const SceneChunk& chunk = found->second;
  mesh_hash_ -= chunk.hash_term;
  --stats_.chunks;
  stats_.vertices -= chunk.mesh.vertices.size();
  stats_.triangles -= chunk.mesh.triangles.size() / 3;
  stats_.sections -= chunk.mesh.sections.size();
  chunks_.erase(found);
}

void Scene::clear() {
  chunks_.clear();
  mesh_hash_ = 0;
  stats_ = {.chunks = 0,
            .triangles = 0,
            .vertices = 0,
            .sections = 0,
            .frames = stats_.frames,
            .bytes = stats_.bytes};
}

}  // namespace earthwork::scene
