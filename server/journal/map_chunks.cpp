#include "server/journal/chunk_place.hpp"
#include "server/journal/keyframe_row.hpp"
#include "server/journal/map_keyframes.hpp"
#include "server/journal/stored_sum.hpp"
#include "server/voxel/chunk_bytes.hpp"

namespace earthwork::journal {
namespace {

using protocol::Failure;
using protocol::Result;
using voxel::Chunk;
using voxel::ChunkKey;

std::uint64_t sum_of(std::int64_t layer, std::int64_t place, std::uint64_t seq,
                     std::string_view bytes) {
  return StoredSum().add(layer).add(place).add(seq).add(bytes).value();
}

/// A row of chunks; rows come in the order of their fields.
struct Row {
  std::int64_t layer = -1, place = 0;
  std::uint64_t seq = 0;
  friend auto operator<=>(const Row&, const Row&) = default;
};

/// The states of all chunks, row by row, and of each chunk the newest up to a keyframe.
class ChunkReader {
 public:
  ChunkReader(const Database& database, int resolution, const KeyframeRow& keyframe)
      : database_(database),
        resolution_(resolution),
        keyframe_(keyframe),
        rows_(database, "chunks",
              "SELECT layer, place, seq, bytes, sum FROM chunks ORDER BY layer, place, seq") {}

  Result<void> read(const std::function<Result<void>(ChunkState)>& take) {
    for (rows_.begin();;) {
      const auto row = rows_.next();
      if (!row) return tl::unexpected<Failure>(row.error());
      if (*row && (!rows_.row_is("iiibi") || !(row_of() > last_)))
        return damaged("a row is none of ours, or not in its place");
      const bool same = *row && row_of().layer == last_.layer && row_of().place == last_.place;
      if (!same && held_)
        if (auto told = tell(take); !told) return told;
      if (!*row) return compare();
      last_ = row_of();
      if (last_.seq <= keyframe_.keyframe.seq) hold();
    }
  }

 private:
  Row row_of() const { return {rows_.integer(0), rows_.integer(1), rows_.number(2)}; }

  tl::unexpected<Failure> damaged(std::string_view sentence) const {
    return database_.damaged("chunks", last_.seq, sentence);
  }

  void hold() {
    const auto bytes = rows_.bytes(3);
    bytes_.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    seq_ = last_.seq;
    sum_ = rows_.number(4);
    held_ = true;
  }

  // What is held is of the chunk of the last row.
  Result<void> tell(const std::function<Result<void>(ChunkState)>& take) {
    held_ = false;
    const std::string where =
        "chunk of layer " + std::to_string(last_.layer) + ", place " + std::to_string(last_.place);
    if (sum_ != sum_of(last_.layer, last_.place, seq_, bytes_))
      return database_.damaged("chunks", seq_, where + ": the sum is another");
    const auto key = key_of(static_cast<std::int32_t>(last_.layer), last_.place);
    const bool known = key && last_.layer >= 0 && last_.layer < 16;
    auto chunk =
        bytes_.empty() ? Chunk(resolution_) : voxel::decode_chunk(std::as_bytes(std::span(bytes_)));
    if (!known || !chunk || chunk->resolution() != resolution_ || chunk->blank() != bytes_.empty())
      return database_.damaged("chunks", seq_, where + ": not the bytes of a chunk of this map");
    ++count_;
    digest_ ^= sum_;
    return take({.key = *key, .seq = seq_, .chunk = std::move(*chunk)});
  }

  Result<void> compare() const {
    if (count_ == keyframe_.chunks && digest_ == keyframe_.digest) return {};
    return database_.damaged("chunks", keyframe_.keyframe.seq,
                             std::to_string(count_) + " states are there, not those " +
                                 std::to_string(keyframe_.chunks) + " of the keyframe");
  }

  const Database& database_;
  int resolution_;
  const KeyframeRow& keyframe_;
  Statement rows_;
  Row last_;
  bool held_ = false;
  std::uint64_t seq_ = 0, sum_ = 0;
  std::string bytes_;
  std::uint64_t count_ = 0, digest_ = 0;
};

}  // namespace

Result<void> put_chunk_rows(Database& database, std::span<const ChunkState> states) {
  Statement put(database, "chunks", "INSERT OR REPLACE INTO chunks VALUES(?, ?, ?, ?, ?)");
  std::string bytes;
  for (const ChunkState& state : states) {
    bytes.clear();
    if (!state.chunk.blank()) voxel::encode_chunk(state.chunk, bytes);
    const std::int64_t layer = state.key.layer, place = place_of(state.key);
    if (auto done = put.run(layer, place, state.seq, std::as_bytes(std::span(std::as_const(bytes))),
                            sum_of(layer, place, state.seq, bytes));
        !done)
      return done;
  }
  return {};
}

// A row since the newest keyframe counts when it is its chunk's newest; it takes the place of the
// row that counted then.
Result<void> count_chunks(Database& database, std::uint64_t since, KeyframeRow& row) {
  Statement changed(database, "chunks",
                    "SELECT layer, place, seq FROM chunks INDEXED BY chunks_by_seq "
                    "WHERE seq > ? AND seq <= ?");
  Statement states(database, "chunks",
                   "SELECT seq, sum FROM chunks WHERE layer = ? AND place = ? AND seq <= ? "
                   "ORDER BY seq DESC");
  for (changed.begin(since, row.keyframe.seq);;) {
    const auto more = changed.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) return {};
    states.begin(changed.integer(0), changed.integer(1), row.keyframe.seq);
    auto state = states.next();
    if (!state) return tl::unexpected<Failure>(state.error());
    if (!*state || states.number(0) != changed.number(2)) continue;
    row.digest ^= states.number(1);
    while (state && *state && states.number(0) > since) state = states.next();
    if (!state) return tl::unexpected<Failure>(state.error());
    if (*state)
      row.digest ^= states.number(1);
    else
      ++row.chunks;
  }
}

Result<void> read_chunks(Database& database, int resolution, std::uint64_t seq,
                         const std::function<Result<void>(ChunkState)>& take) {
  const auto keyframe = find_keyframe(database, seq);
  if (!keyframe) return tl::unexpected<Failure>(keyframe.error());
  return ChunkReader(database, resolution, *keyframe).read(take);
}

}  // namespace earthwork::journal
