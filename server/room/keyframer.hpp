/// Makes keyframes of a map that goes on: it gathers what changed, takes cheap copies of that when
/// enough has, and has the clerk put them into the journal a few at a time, so that nobody waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "server/history/event.hpp"
#include "server/journal/clerk.hpp"
#include "server/journal/restore.hpp"
#include "server/room/mesh_round.hpp"
#include "server/room/meters.hpp"
#include "server/room/strand.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// When a keyframe is due.
struct KeyframePace {
  /// So many events after the last one: they are what a start has to repeat, some 10 us each.
  std::uint64_t events = 4096;
  /// Or with so many chunks that are different: copies of them are taken within a millisecond.
  std::size_t chunks = 4096;
};
/// What the clerk puts in one task: a commit that comes meanwhile waits for it.
inline constexpr std::size_t kChunksPerTask = 32;
inline constexpr std::size_t kAuthorsPerTask = 4;
inline constexpr std::size_t kRowsTidiedPerTask = 256;

/// One keyframe is in the making at a time; what changes meanwhile gathers for the next. One that
/// could not be put is dropped: what it was made of counts as changed again, and
/// KeyframePace::events later the next is made. Takes memory for the keys of what changed and,
/// while a keyframe is in the making, for what the map no longer shares with the copies.
///
/// On the strand of the room whose part it is.
class Keyframer {
 public:
  struct Subject {
    const voxel::Map& map;
    const protocol::MapSettings& settings;  ///< The map's, with all that was accepted.
    /// What is remembered of an author, with all that was accepted.
    std::function<journal::AuthorState(std::uint64_t author)> author;
    journal::Clerk& clerk;
    /// Called on the strand, for each task of the clerk; its `back` tells the outcome, later or
    /// from within the call.
    std::function<Workplace()> workplace;
    const Strand& clock;
    std::shared_ptr<Meters> meters;  ///< Counts what is put, and what fails.
  };
  /// `start` is how the map began: all of it is durable. What `subject` refers to outlives it.
  Keyframer(Subject subject, const journal::Restored& start, KeyframePace pace = {});
  ~Keyframer();
  Keyframer(const Keyframer&) = delete;
  Keyframer& operator=(const Keyframer&) = delete;

  /// The map has this event now, which changed these chunks' voxels: `Change::changed`.
  void accepted(const history::Event& event, std::span<const voxel::ChunkKey> changed);

  /// All that was accepted is about to be appended as one batch, and nothing else is on its way.
  /// Takes the copies for a keyframe as of it when one is due.
  void handed_over();
  /// That batch is durable: a keyframe as of it may be put.
  void durable();
  /// That batch failed: all that was accepted after the last durable one is taken back, also what
  /// was accepted since the hand-over. To be called once the map is as it was.
  void taken_back();

  /// Makes a last keyframe if anything happened since the newest, after the one in the making, and
  /// then calls `done`, whether or not it could be made: maybe from within the call. `done` must
  /// not end this object. When nothing is accepted that is not durable; should something be
  /// accepted before `done`, the keyframe may be left out. Not again before `done`.
  void finish(std::function<void()> done);

  /// Nobody waits for that `done` any more: it is not called.
  void give_up() { finished_ = nullptr; }

  /// Nothing is with the clerk, or waits for a batch.
  [[nodiscard]] bool resting() const { return !attempt_; }

 private:
  using ChunkSeqs = std::unordered_map<voxel::ChunkKey, std::uint64_t, voxel::ChunkKeyHash>;
  struct Moment {
    std::uint64_t seq = 0, hash = 0;
  };
  struct Attempt;

  [[nodiscard]] bool due() const;
  void begin();
  void go_on();
  void came(const protocol::Result<bool>& outcome);
  void note_put();
  void drop();
  void wind_up();

  const Subject subject_;
  const KeyframePace pace_;
  Moment accepted_, handed_over_, durable_;    // each at or after the next
  ChunkSeqs changed_;                          // since the newest keyframe: by which event last
  std::unordered_set<std::uint64_t> authors_;  // likewise: who has new ids
  std::uint64_t newest_seq_;                   // of a keyframe that is put
  std::uint64_t tried_seq_;                    // of the last one that was, or could not be
  std::unique_ptr<Attempt> attempt_;           // has taken over changed_ and authors_
  bool posting_ = false;
  std::function<void()> finished_;  // set: a last one is wanted,
  bool last_ = false;               // and in the making
};

}  // namespace earthwork::room
