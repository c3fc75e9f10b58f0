#include "server/journal/keyframe_check.hpp"

#include <string>
#include <unordered_set>
#include <utility>

#include "protocol/chunk_record.hpp"

namespace earthwork::journal {
namespace {

using protocol::Failure;
using protocol::Result;

std::string text_of(const voxel::ChunkKey& key) {
  return "(" + std::to_string(key.layer) + ", " + std::to_string(key.x) + ", " +
         std::to_string(key.y) + ", " + std::to_string(key.z) + ")";
}

/// The chunks of one keyframe, as they are told one by one.
class ChunkCheck {
 public:
  ChunkCheck(std::uint64_t keyframe_seq, const Execution& executed, Findings& findings)
      : keyframe_seq_(keyframe_seq), executed_(executed), findings_(findings) {}

  void look_at(const ChunkState& state) {
    seen_.insert(state.key);
    const voxel::Chunk* chunk = executed_.map.find(state.key);
    const bool same = chunk ? chunk->hash() == state.chunk.hash() : state.chunk.blank();
    if (!same) return wrong(state.seq, state.key, "is not what the log gives");
    const std::uint64_t age = executed_.ages.of(state.key);
    if (state.seq < age || state.seq > keyframe_seq_)
      wrong(state.seq, state.key, "is from seq " + std::to_string(age) + " by the log");
  }
  void find_missing() {
    for (const ChunkAge& age : executed_.ages.in_order())
      if (!seen_.contains(age.key)) wrong(age.seq, age.key, "is missing");
  }

 private:
  void wrong(std::uint64_t seq, const voxel::ChunkKey& key, const std::string& what) {
    findings_.add(
        "chunks", seq,
        "chunk " + text_of(key) + " of keyframe " + std::to_string(keyframe_seq_) + " " + what);
  }

  const std::uint64_t keyframe_seq_;
  const Execution& executed_;
  Findings& findings_;
  std::unordered_set<voxel::ChunkKey, voxel::ChunkKeyHash> seen_;
};

}  // namespace

Result<bool> check_keyframe(Journal& journal, const Keyframe& keyframe, const Execution& executed,
                            Findings& findings) {
  const std::size_t before = findings.count();
  if (keyframe.map_hash != executed.hash)
    findings.add("keyframes", keyframe.seq,
                 "the stored hash is " + protocol::hex(keyframe.map_hash) + ", executed it is " +
                     protocol::hex(executed.hash));
  if (keyframe.settings != executed.settings)
    findings.add("keyframes", keyframe.seq, "its settings are not what the log gives");
  ChunkCheck check(keyframe.seq, executed, findings);
  auto told = journal.chunks(keyframe.seq, [&check](const ChunkState& state) -> Result<void> {
    check.look_at(state);
    return {};
  });
  if (told)
    check.find_missing();
  else if (auto taken = findings.take(std::move(told.error())); !taken)
    return tl::unexpected<Failure>(std::move(taken.error()));
  return findings.count() == before;
}

}  // namespace earthwork::journal
