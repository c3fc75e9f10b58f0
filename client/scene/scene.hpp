/// The meshes of a map as a viewer has them, put together from frames alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "client/scene/holding.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/frame.hpp"
#include "protocol/limits.hpp"
#include "protocol/result.hpp"

namespace earthwork::scene {

/// What a scene holds at most, and a group in progress too: a full view on every layer.
inline constexpr std::size_t kMaxSceneChunks = protocol::kMaxViewChunks * protocol::kMaxLayers;

struct SceneChunk {
  std::uint64_t revision = 0;  ///< The seq at which the mesh came to be.
  protocol::ChunkMesh mesh;
  std::uint64_t hash_term = 0;  ///< What it adds to the scene's mesh hash.
};

struct SceneStats {
  std::uint64_t chunks = 0, triangles = 0, vertices = 0, sections = 0;  ///< Held now.
  std::uint64_t frames = 0, bytes = 0;                                  ///< Received in all.
  friend bool operator==(const SceneStats&, const SceneStats&) = default;
};

/// What a drawing of the scene needs to be brought up to date.
struct SceneChanges {
  std::vector<protocol::ChunkKey> keys;  ///< In order, each once; gone if `chunks` has none.
  bool all = false;  ///< Nothing that was there before stays; `keys` are all that is held.
  friend bool operator==(const SceneChanges&, const SceneChanges&) = default;
};

/// Told of the join before anything else, then of all that arrives, in order. One thread at a time.
class Scene {
 public:
  using Chunks = std::map<protocol::ChunkKey, SceneChunk>;

  /// The map was joined, in this epoch and at `map_seq`. Meshes stay where `have` claims them; all
  /// others go, for the server does not know of them.
  void join(std::uint64_t epoch, std::uint64_t map_seq = std::numeric_limits<std::uint64_t>::max());
  /// View `n` was asked for, all of the map without a rectangle: meshes outside it go, and those
  /// that are still on their way are dropped. Before it, everything is inside.
  void look(std::uint32_t n, const std::optional<protocol::MapRect>& rect,
            const protocol::MapSettings& settings);
  /// All of view `n` has arrived, as of `seq`.
  void catch_up(std::uint32_t n, std::uint64_t seq);

  /// Takes what was complete with one binary message of `message_bytes`, in order; the records are
  /// moved from. A record outside a group is applied at once; those of a group together at its
  /// end, and a group of another epoch replaces all there was. A delta changes the mesh that the
  /// group has of its chunk so far, or that is held: bad_frame when there is none, or one of
  /// another revision, unless the group belongs to an earlier view. Fails with bad_frame or
  /// too_large; after that the scene must not be fed again.
  [[nodiscard]] protocol::Result<void> take(std::span<protocol::FrameEvent> events,
                                            std::size_t message_bytes);

  /// The chunks that are new, different or gone since the last call; at the first one all that is
  /// held. For a single drawing. A scene that is never asked keeps nothing for it, and of more
  /// than kMaxSceneChunks changes it is all.
  [[nodiscard]] SceneChanges take_changed();
  /// Something is to be taken.
  [[nodiscard]] bool changed() const { return !changed_ || !changed_->empty(); }

  /// Those that have a mesh. Valid until the next change.
  [[nodiscard]] const Chunks& chunks() const { return chunks_; }
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  /// The last event that all meshes show; 0 before it is known. A mesh may already show more.
  [[nodiscard]] std::uint64_t seq() const { return seq_; }
  /// The number of the last view that is complete, if one is.
  [[nodiscard]] std::optional<std::uint32_t> complete_view() const { return complete_view_; }
  /// What a view that is asked for after the next join may claim; nothing when there was no view
  /// with a number given to `look`, or none was complete.
  [[nodiscard]] std::optional<protocol::Have> have() const { return holding_.have(); }
  /// Of all that is held (GEOMETRY: "Hashes"), kept up to date: asking costs nothing.
  [[nodiscard]] std::uint64_t mesh_hash() const { return mesh_hash_; }
  [[nodiscard]] const SceneStats& stats() const { return stats_; }

 private:
  struct Group {
    protocol::GroupBegin begin;
    std::map<protocol::ChunkKey, protocol::ChunkRecord> records;
  };

  protocol::Result<void> take_begin(const protocol::GroupBegin& begin);
  protocol::Result<void> take_record(protocol::ChunkRecord& record);
  protocol::Result<void> take_delta(const protocol::ChunkDelta& delta);
  /// The mesh that the delta starts from; null when it is not held.
  const protocol::ChunkMesh* base_of(const protocol::ChunkDelta& delta) const;
  protocol::Result<void> take_end(const protocol::GroupEnd& end);
  protocol::Result<void> apply(protocol::ChunkRecord& record);
  void put(const protocol::ChunkKey& key, SceneChunk chunk);
  void drop(const protocol::ChunkKey& key);
  void note(const protocol::ChunkKey& key);
  template <class Stays>
  void keep_only(const Stays& stays);
  void clear();

  Chunks chunks_;
  std::optional<Group> group_;
  std::uint64_t epoch_ = 0, seq_ = 0, mesh_hash_ = 0;
  std::optional<std::uint32_t> last_view_, complete_view_;  // asked for, all there
  Holding holding_;
  SceneStats stats_;
  std::optional<std::set<protocol::ChunkKey>> changed_;  // none: all, or nobody has asked yet
};

}  // namespace earthwork::scene
