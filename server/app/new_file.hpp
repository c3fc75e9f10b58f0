/// A file that is there as a whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

namespace earthwork::app {

/// Written beside its place, and put there at the end: what was there before stays until then.
/// Without `finish` nothing is left of it. Failures: disk_full, storage_failed.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Fails when the file cannot be made, or does not take it.
  [[nodiscard]] protocol::Result<void> write(std::string_view bytes);
  /// Puts the file into its place. Nothing can be written any more.
  [[nodiscard]] protocol::Result<void> finish();
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] tl::unexpected<protocol::Failure> failed(int error) const;

  std::filesystem::path path_, beside_;
  std::ofstream file_;
  int open_error_;  // of errno's
  std::uint64_t bytes_ = 0;
};

}  // namespace earthwork::app
