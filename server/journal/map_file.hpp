/// A map as one ordinary file: SQLite, in tables that the sqlite3 shell shows.
///
/// (The format's specification stands here: see the tables below.)
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
  write,
  read,  ///< Changes nothing, not even what a crash has left beside the file.
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
