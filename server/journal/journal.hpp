/// What a map needs to outlive the process that serves it: its log of events, and now and then the
/// state of its chunks, so that a start does not repeat the whole log.
///
/// The log is the truth. A keyframe - chunks, settings, and what is remembered of authors, as of
/// one seq - is made from it and can be made again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/history/event.hpp"
#include "server/voxel/chunk.hpp"
#include "server/voxel/chunk_key.hpp"

namespace earthwork::journal {

/// What is fixed when a map is created.
struct Identity {
  protocol::MapSettings settings;  ///< Before the first event.
  std::uint64_t epoch = 0;
  std::int64_t created_ms = 0;  ///< Since 1970, UTC.
  friend bool operator==(const Identity&, const Identity&) = default;
};

/// A chunk as it is since an event that is not after `seq`: it did not change from `seq` to the
/// keyframe it belongs to. A blank one says that there is nothing any more.
struct ChunkState {
  voxel::ChunkKey key;
  std::uint64_t seq = 0;
  voxel::Chunk chunk;
};

/// The ids of an author that are remembered, with the seqs of their events: both increase, and
/// there are at most protocol::kMaxRememberedIds, the last ones.
struct AuthorState {
  struct Applied {
    protocol::MessageId id = 0;
    std::uint64_t seq = 0;
    friend bool operator==(const Applied&, const Applied&) = default;
  };
  std::uint64_t author = 0;
  std::vector<Applied> applied;
  friend bool operator==(const AuthorState&, const AuthorState&) = default;
};

/// With it, the chunk states up to `seq` are all there are: what it names has been put.
struct Keyframe {
  std::uint64_t seq = 0;
  std::uint64_t map_hash = 0;        ///< voxel::Map::hash() as of `seq`.
  std::int64_t time_ms = 0;          ///< When it was made.
  protocol::MapSettings settings{};  ///< As of `seq`.
  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

/// One map's. One thread at a time.
///
/// Failures: `disk_full`, `read_only`, `storage_failed` when something could not be written or read
/// now, and may be later; `damaged` when what was written is not what is there: its detail names
/// file, table and seq. Details are for anybody: of a file they tell its name, and never where it
/// is. After any failure what was there before is still there.
class Journal {
 public:
  virtual ~Journal() = default;

  /// What its failures call it: its file's name; empty where there is no file.
  [[nodiscard]] virtual std::string_view name() const { return {}; }
  [[nodiscard]] virtual const Identity& identity() const = 0;
  /// Of the last event; 0 before the first one.
  [[nodiscard]] virtual std::uint64_t last_seq() const = 0;

  /// Adds events, one or more, numbered without a gap from `expected_seq` + 1 on: all or none. When
  /// it succeeds they are durable. Fails with bad_state when the last seq is not `expected_seq`,
  /// for somebody else has written; or when nobody can tell now whether the events are there. The
  /// caller must not go on then, nor say what became of them: the journal tells that once it was
  /// opened again.
  [[nodiscard]] virtual protocol::Result<void> append(std::uint64_t expected_seq,
                                                      std::span<const history::Event> events) = 0;
  /// Events from `from_seq` on, in order: as many as fit into `most_bytes`, at least one, none when
  /// there is none. Bytes are those that the events take here.
  [[nodiscard]] virtual protocol::Result<std::vector<history::Event>> events(
      std::uint64_t from_seq, std::size_t most_bytes) = 0;

  /// States that a keyframe will be made of; they count only once it is. Each call is durable or
  /// lost as a whole, so a caller that must not hold up what comes behind it puts a few at a time.
  [[nodiscard]] virtual protocol::Result<void> put_chunks(std::span<const ChunkState> states) = 0;
  /// Replaces what was put of these authors before.
  [[nodiscard]] virtual protocol::Result<void> put_authors(
      std::span<const AuthorState> authors) = 0;
  /// All chunks that changed since the last keyframe have been put as of `keyframe.seq`, and all
  /// authors that have new ids. Its seq is above the last one's, and not above last_seq().
  [[nodiscard]] virtual protocol::Result<void> put_keyframe(const Keyframe& keyframe) = 0;
  /// Removes up to `most` rows that no keyframe needs: states that were superseded, or whose
  /// keyframe was never put. True when none is left.
  [[nodiscard]] virtual protocol::Result<bool> tidy(std::size_t most) = 0;

  /// Those that are kept, by seq.
  [[nodiscard]] virtual protocol::Result<std::vector<Keyframe>> keyframes() = 0;
  /// Tells the newest state up to keyframe `seq` of every chunk that has one, in no order; the
  /// blank ones too. A failure that `take` returns ends it.
  [[nodiscard]] virtual protocol::Result<void> chunks(
      std::uint64_t seq, const std::function<protocol::Result<void>(ChunkState)>& take) = 0;
  /// All that were put, in order of their authors: up to the newest keyframe at least, perhaps
  /// further.
  [[nodiscard]] virtual protocol::Result<std::vector<AuthorState>> authors() = 0;
};

}  // namespace earthwork::journal
