/// A map file's states as of its keyframes: the tables chunks, authors and keyframes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "server/journal/database.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// What begins with put or drop runs within a transaction.
[[nodiscard]] protocol::Result<void> put_chunk_rows(Database& database,
                                                    std::span<const ChunkState> states);
[[nodiscard]] protocol::Result<void> put_author_rows(Database& database,
                                                     std::span<const AuthorState> authors);
/// Counts what it stands for: chunk rows since the newest keyframe, and all authors.
[[nodiscard]] protocol::Result<void> put_keyframe_row(Database& database, const Keyframe& keyframe);

/// As the Journal's functions; `resolution` is the map's.
[[nodiscard]] protocol::Result<void> read_chunks(
    Database& database, int resolution, std::uint64_t seq,
    const std::function<protocol::Result<void>(ChunkState)>& take);
[[nodiscard]] protocol::Result<std::vector<AuthorState>> read_authors(Database& database);
[[nodiscard]] protocol::Result<std::vector<Keyframe>> read_keyframes(Database& database);
/// The newest one's seq; 0 without one.
[[nodiscard]] protocol::Result<std::uint64_t> newest_keyframe(Database& database);

/// Removes those that are not kept, see kept_keyframes. Their chunk rows are left to MapTidying.
[[nodiscard]] protocol::Result<void> drop_keyframes(Database& database);

}  // namespace earthwork::journal
