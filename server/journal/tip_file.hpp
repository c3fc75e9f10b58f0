/// A witness of the last event that was durable, beside the map file while it is open for writing.
///
/// A log that lost its end, or all of SQLite's write-ahead file, is a sound shorter log; only
/// somebody who was there can tell. The file NAME.earthwork-tip has 24 bytes: u64 seq, u64 hash of
/// the map after it, u64 XXH3-64 over those two, little-endian. It is written over after each
/// commit, and not synced: a process that is killed has told it to the system by then, and after a
/// loss of power an older one is true as well.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "protocol/result.hpp"

namespace earthwork::journal {

struct Tip {
  std::uint64_t seq = 0, hash = 0;
  friend bool operator==(const Tip&, const Tip&) = default;
};

/// Where a map file's tip is.
[[nodiscard]] std::filesystem::path tip_path(const std::filesystem::path& map_file);
/// None where there is no file; `damaged` when it does not read as one, naming it.
[[nodiscard]] protocol::Result<std::optional<Tip>> read_tip(const std::filesystem::path& path);

/// Open for writing.
class TipFile {
 public:
  /// Goes on with the file that is there, or makes one as a whole.
  [[nodiscard]] static protocol::Result<TipFile> open(const std::filesystem::path& path,
                                                      const Tip& tip);
  ~TipFile();
  TipFile(TipFile&& other) noexcept;
  TipFile& operator=(TipFile&& other) noexcept;

  /// What cannot be written leaves an older tip, which is true as well.
  void write(const Tip& tip);

 private:
  explicit TipFile(int file) : file_(file) {}
  int file_;
};

}  // namespace earthwork::journal
