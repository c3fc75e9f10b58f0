/// Files that are there as a whole or not at all, also when the power fails.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace earthwork::journal {

/// What errno says, as a journal tells it: disk_full, read_only or storage_failed. `name` is what
/// the failure calls the file.
[[nodiscard]] protocol::Failure system_failure(int error, const std::string& name);

/// A path in the folder of `path` that no other call of this process gives, to build or to take
/// away a file under. What a crash leaves there, is_unfinished tells by its file name.
[[nodiscard]] std::filesystem::path unfinished_path(const std::filesystem::path& path);
[[nodiscard]] bool is_unfinished(std::string_view file_name);

/// What the file holds survives a loss of power; then the same for the names in a folder.
[[nodiscard]] protocol::Result<void> sync_file(const std::filesystem::path& path);
[[nodiscard]] protocol::Result<void> sync_folder_of(const std::filesystem::path& path);

/// Gives a synced file its name. Fails with map_exists when there is something of that name.
[[nodiscard]] protocol::Result<void> rename_new(const std::filesystem::path& from,
                                                const std::filesystem::path& to);
/// Fine where there is none.
[[nodiscard]] protocol::Result<void> remove_file(const std::filesystem::path& path);
/// What SQLite and a journal keep beside a map file while it is open.
[[nodiscard]] protocol::Result<void> remove_companions(const std::filesystem::path& path);

}  // namespace earthwork::journal
