// A disk that fails on purpose: SQLite's default file system, which from some moment on is full,
// does not sync, or loses its power.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>

namespace earthwork::journal {

/// SQLite's default as long as it lives. What is opened through it is closed before. Files that
/// SQLite shares (-shm) find no room on a full disk, and are left alone otherwise: they may be lost
/// at any time.
class FaultVfs {
 public:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Counted from the call on; the write and sync of that number, from 1, and all later ones fail,
  /// or as many syncs as said.
  void fill_disk_at_write(std::size_t number) { full_at_ = writes_ + number; }
  void fail_at_sync(std::size_t number, std::size_t many = kNever) {
    no_sync_at_ = syncs_ + number;
    syncs_failing_ = many;
  }
  void mend();

  /// Of the files opened from now on, remembers what of them is synced.
  void watch();
  /// The power fails: of what was not synced each sector of 512 bytes is there or not, by lot, or
  /// all of it is lost; later writes and syncs fail.
  enum class Loss { whole, torn };
  void lose_power(Loss loss, std::uint64_t seed);

  std::size_t writes() const { return writes_; }
  std::size_t syncs() const { return syncs_; }

  struct Parts;

 private:
  friend struct Parts;
  std::size_t writes_ = 0, syncs_ = 0;
  std::size_t full_at_ = kNever, no_sync_at_ = kNever, syncs_failing_ = 0;
  bool watching_ = false, dead_ = false;
  std::unique_ptr<Parts> parts_;
};

}  // namespace earthwork::journal
