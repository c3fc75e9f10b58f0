/// A map in a data directory that no server uses meanwhile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "server/app/map_flags.hpp"
#include "server/journal/data_directory.hpp"
#include "server/journal/journal.hpp"
#include "server/journal/restore.hpp"

namespace earthwork::app {

/// Only reads: the file stays as it is, damaged or not. Holds the directory's lock.
struct StoredMap {
  std::unique_ptr<journal::DataDirectory> folder;
  std::string name;
  std::filesystem::path path;
  std::unique_ptr<journal::Journal> journal;
};

/// The map that the flags name. Fails with bad_name, as DataDirectory::open does, and as
/// open_map_file does.
[[nodiscard]] protocol::Result<StoredMap> open_stored_map(const MapFlags& flags);

/// Of the map file and its write-ahead log.
[[nodiscard]] std::uint64_t file_bytes(const std::filesystem::path& path);

/// Since 1970, UTC.
[[nodiscard]] std::int64_t now_ms();

/// Fails with bad_name.
[[nodiscard]] protocol::Result<void> check_name(const std::string& name);

/// As of `seq` or the last event. What is damaged is passed over as long as the log is good, and
/// people are told on stderr. Fails as journal::restore does.
[[nodiscard]] protocol::Result<journal::Restored> salvage(const StoredMap& stored,
                                                          std::optional<std::uint64_t> seq);

}  // namespace earthwork::app
