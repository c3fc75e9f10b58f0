/// A map as one ordinary file: SQLite, in tables that the sqlite3 shell shows.
///
/// application_id is 0x45576D70 ("EWmp"), user_version is the format, 1; the file is in WAL mode,
/// its texts are UTF-8. 64-bit numbers without sign (hashes, sums, authors) stand as SQLite's
/// signed integers of the same bits; printf('%016x', hash) shows them as everywhere else. A sum is
/// XXH3-64, seed 0, over the fields named, in that order: integers as 8 bytes, little-endian; texts
/// and bytes after their length as such an integer.
///
/// meta(key, value), both texts
///     settings: JSON, as protocol::write_settings gives it; epoch: 16 hex digits; created_ms:
///     since 1970, decimal; sum: 16 hex digits, over key and value of the others in the order of
///     their keys.
///
/// events(seq, time_ms, author, id, kind, command, hash)
///     seq: 1, 2, 3 ... without gaps. kind: "edit" or "layer"; another one is for later versions.
///     command: its fields as JSON, as protocol::write_fields gives them. hash: the map's after it.
///
/// batches(first_seq, last_seq, sum)
///     What was committed together; they follow each other without gaps and end with the last
///     event. sum: over its events in order, of each one seq, time_ms, author, id, kind, command,
///     hash.
///
/// keyframes(seq, map_hash, time_ms, chunks, digest, authors, settings, sum)
///     map_hash: after event seq. time_ms: when it was made. chunks: how many chunks have a state
///     up to seq; digest: the sums of the newest of each one's, XORed. authors: how many there
///     were. settings: as of seq, JSON like those of meta, which are those before the first event.
///     sum: over the columns before it. Kept are the newest keyframe, and older ones at least
///     65,536 events apart.
///
/// chunks(layer, place, seq, bytes, sum)
///     The state of a chunk since event seq or longer, up to the next row of the same layer and
///     place, or the keyframe it was put for. place: chunk_place.hpp. bytes: voxel/chunk_bytes.hpp,
///     none when there is nothing any more. sum: over the columns before it. Rows after the newest
///     keyframe are of one that was not finished and count for nothing. chunks_by_seq indexes them.
///
/// authors(author, ids, sum)
///     ids: author_ids.hpp, up to the newest keyframe at least. sum: over the columns before it.
///
/// For example, who painted how much, and what the last edits were:
///     SELECT printf('%016x', author), count(*) FROM events GROUP BY author;
///     SELECT seq, datetime(time_ms / 1000, 'unixepoch'), kind, command FROM events
///       ORDER BY seq DESC LIMIT 5;
///
/// Nothing but the log is needed: keyframes, chunks and authors, emptied together, are made again.
/// Other tables, indexes, views or triggers make it no map file.
///
/// While a map is open for writing, SQLite's NAME.earthwork-wal and -shm lie beside it, and
/// NAME.earthwork-tip (tip_file.hpp). After a crash the -wal is part of the map. A tip that knows
/// of more events than there are tells that acknowledged ones are missing; who wants to go on with
/// what is there removes it. Downsides: a command is JSON, some 100 bytes an event, so that people
/// can read it; the log is never shortened; and flipped bytes are found only when they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

inline constexpr const char* kMapFileSuffix = ".earthwork";

/// A new file, empty but for its identity: there after the call as a whole or not at all, also
/// when the power fails. Fails with map_exists, or as a journal does.
[[nodiscard]] protocol::Result<std::unique_ptr<Journal>> create_map_file(
    const std::filesystem::path& path, const Identity& identity);

enum class Access {
  /// All of the log is read and compared with its sums, about a second for a million events: what
  /// is damaged anywhere, or has lost its end, is not opened. Without room, or where nothing may be
  /// written, it is opened all the same; writing then fails until it can be done. Appending fails
  /// with `damaged` once the file was taken away, or another one put in its place.
  write,
  /// Changes nothing, not even what a crash has left beside the file. A log that has lost its end
  /// is opened: last_seq() is the last that there was, as far as anything tells, and reading what
  /// is missing fails with `damaged`.
  read,
};
/// Fails with unknown_map where there is no file, with bad_version for another format or a later
/// version of it, with `damaged` when it is no such file or what it needs to be read is not there.
[[nodiscard]] protocol::Result<std::unique_ptr<Journal>> open_map_file(
    const std::filesystem::path& path, Access access);

/// A file of its own with the same log and states, up to `seq` or whole, under a new identity's
/// epoch and time; the settings stay. Neither file is changed but `to`, which is there as a whole
/// or not at all. Fails with map_exists, out_of_range, or as a journal does.
[[nodiscard]] protocol::Result<void> fork_map_file(const std::filesystem::path& from,
                                                   const std::filesystem::path& to,
                                                   std::uint64_t epoch, std::int64_t created_ms,
                                                   std::optional<std::uint64_t> seq);

/// Removes the file and what lies beside it. Fails with unknown_map, or as a journal does. Nobody
/// has it open.
[[nodiscard]] protocol::Result<void> remove_map_file(const std::filesystem::path& path);

}  // namespace earthwork::journal
