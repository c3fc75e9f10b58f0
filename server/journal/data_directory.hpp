/// The folder that a server keeps its maps in: one file a map, and a lock for one process at a
/// time.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"

namespace earthwork::journal {

/// Holds the lock as long as it lives; the system lets go of it when the process ends in any way.
class DataDirectory {
 public:
  enum class Missing { create, refuse };
  /// Fails with bad_state when another process has it, naming its pid; with unknown_map when it is
  /// missing and is not to be created; with disk_full, read_only or storage_failed. Where nothing
  /// may be written, on a snapshot say, it can be read: under the lock if there is one.
  [[nodiscard]] static protocol::Result<std::unique_ptr<DataDirectory>> open(
      const std::filesystem::path& folder, Missing missing);
  ~DataDirectory();
  DataDirectory(const DataDirectory&) = delete;
  DataDirectory& operator=(const DataDirectory&) = delete;

  /// Where the map of this name is, or would be; the name is valid.
  [[nodiscard]] std::filesystem::path map_file(std::string_view name) const;
  /// The names of all map files, sound or not, in alphabetic order.
  [[nodiscard]] protocol::Result<std::vector<std::string>> map_names() const;

 private:
  DataDirectory(std::filesystem::path folder, int lock) : folder_(std::move(folder)), lock_(lock) {}
  std::filesystem::path folder_;
  int lock_;
};

}  // namespace earthwork::journal
