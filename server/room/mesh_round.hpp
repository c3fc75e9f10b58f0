/// A round of meshing: the chunks that viewers wait for, as of one seq, made on the thread pool
/// while the map goes on.
///
/// It is cut into slices. A few run side by side, and each is followed by the next through the
/// pool's own line, so that whatever else waits there gets its turn between them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "server/room/mesh_cache.hpp"
#include "server/room/mesh_maker.hpp"
#include "server/room/meters.hpp"
#include "server/room/strand.hpp"
#include "server/voxel/kept_neighbourhood.hpp"

namespace earthwork::room {

/// Where a round's work runs. Either may be called from any thread and takes no task any more once
/// the room is gone.
struct Workplace {
  std::function<void(Strand::Task)> aside;  ///< On the thread pool.
  std::function<void(Strand::Task)> back;   ///< On the room's strand.
};

/// Nobody waits for a pool to run more of a round's slices side by side than these.
inline constexpr std::size_t kSlicesAtOnce = 4;

/// Made, started and asked on the room's strand; held by shared_ptr, and kept alive by its slices,
/// which touch nothing but what it holds.
class MeshRound : public std::enable_shared_from_this<MeshRound> {
 public:
  using Makers = std::vector<std::unique_ptr<MeshMaker>>;

  /// Of `keys`, one or more and all different, as they are now: at `seq`.
  MeshRound(const voxel::Map& map, const MeshCache& cache, std::span<const voxel::ChunkKey> keys,
            std::uint64_t seq);

  /// With a slice at a time for each of `makers`, one or more. Counted in `meters`. `done` is
  /// called on the strand when it is over, maybe later than `help` has said so, or not at all then.
  void start(Workplace place, Makers makers, std::shared_ptr<Meters> meters,
             std::function<void()> done);

  /// Makes up to `budget` meshes here and now, and takes them off it. True when the round is over;
  /// for that it waits for slices that run at the moment, but for none that waits itself.
  bool help(MeshMaker& maker, std::size_t& budget);

  /// Once it is over: puts all into the cache and gives the makers back. Throws what a slice threw.
  [[nodiscard]] Makers finish(MeshCache& cache);

 private:
  struct Item {
    voxel::ChunkKey key;
    voxel::KeptNeighbourhood chunks;
    Forerunner before;
    std::optional<CachedMesh> made;
  };

  void run_slice(std::size_t lane);
  std::span<Item> take(std::size_t most);
  bool make(std::span<Item> items, MeshMaker& maker);

  const std::size_t count_;
  std::vector<Item> items_;
  std::atomic<std::size_t> taken_{0};  // items that somebody works at or has made, from the first
  std::atomic<std::size_t> left_;      // items that are not made yet
  std::atomic_flag failed_;
  std::exception_ptr failure_;  // of the first that failed

  Workplace place_;
  Makers makers_;
  std::shared_ptr<Meters> meters_;
  std::function<void()> done_;
};

}  // namespace earthwork::room
