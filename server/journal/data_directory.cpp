#include "server/journal/data_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "protocol/settings.hpp"
#include "server/journal/durable_files.hpp"
#include "server/journal/map_file.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;
namespace fs = std::filesystem;

/// The pid in a lock file, or what stands for it.
std::string holder(int lock) {
  std::array<char, 20> text{};
  const ssize_t size = ::pread(lock, text.data(), text.size(), 0);
  std::string pid(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  pid.erase(std::find_if(pid.begin(), pid.end(), [](char c) { return c < '0' || c > '9'; }),
            pid.end());
  return pid.empty() ? "of an unknown number" : pid;
}

constexpr int kNoLock = -1;

bool may_only_read(int error) { return error == EROFS || error == EACCES || error == EPERM; }

/// The locked file; it stays in the folder when the lock is let go, so that all lock the same one.
/// kNoLock where none is needed, for nothing can be written.
Result<int> take_lock(const fs::path& folder) {
  const fs::path path = folder / "lock";
  constexpr int kFlags = O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
  int lock = ::open(path.c_str(), O_RDWR | O_CREAT | kFlags, 0644);
  if (lock < 0 && may_only_read(errno)) {
    // A snapshot, say: it can be locked all the same. Without the file nobody has written there.
    lock = ::open(path.c_str(), O_RDONLY | kFlags);
    if (lock < 0 && errno == ENOENT) return kNoLock;
  }
  if (lock < 0) return tl::unexpected<Failure>(system_failure(errno, path.string()));
  if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    auto failure = error == EWOULDBLOCK
                       ? Failure{Code::bad_state,
                                 folder.string() + " is in use by process " + holder(lock),
                                 {}}
                       : system_failure(error, path.string());
    ::close(lock);
    return tl::unexpected<Failure>(std::move(failure));
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (::ftruncate(lock, 0) != 0 ||
      ::pwrite(lock, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    // The lock holds all the same; only its holder's number is not told.
  }
  return lock;
}

Result<void> make_folder(const fs::path& folder, DataDirectory::Missing missing) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return {};
  if (missing == DataDirectory::Missing::refuse)
    return fail(Code::unknown_map, folder.string() + ": there is no such folder");
  std::vector<fs::path> made;  // the innermost first
  const fs::path whole = fs::absolute(folder, error).lexically_normal();
  for (fs::path path = whole; path.has_relative_path(); path = path.parent_path())
    if (path.has_filename() && !fs::exists(path, error)) made.push_back(path);
  fs::create_directories(folder, error);
  if (error) return tl::unexpected<Failure>(system_failure(error.value(), folder.string()));
  for (const fs::path& path : made)
    if (auto synced = sync_folder_of(path); !synced) return synced;
  return {};
}

/// The names of all ordinary files in the folder.
Result<std::vector<std::string>> file_names(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (std::error_code none; it->symlink_status(none).type() == fs::file_type::regular)
      names.push_back(it->path().filename().string());
  if (error) return tl::unexpected<Failure>(system_failure(error.value(), "the data directory"));
  return names;
}

}  // namespace

Result<std::unique_ptr<DataDirectory>> DataDirectory::open(const fs::path& folder,
                                                           Missing missing) {
  if (auto made = make_folder(folder, missing); !made)
    return tl::unexpected<Failure>(std::move(made.error()));
  const auto lock = take_lock(folder);
  if (!lock) return tl::unexpected<Failure>(lock.error());
  std::unique_ptr<DataDirectory> directory(new DataDirectory(folder, *lock));
  const auto names = file_names(folder);
  if (!names) return tl::unexpected<Failure>(names.error());
  for (const std::string& name : *names)
    if (is_unfinished(name)) static_cast<void>(remove_file(folder / name));
  return directory;
}

DataDirectory::~DataDirectory() {
  if (lock_ != kNoLock) ::close(lock_);
}

fs::path DataDirectory::map_file(std::string_view name) const {
  return folder_ / (std::string(name) + kMapFileSuffix);
}

Result<std::vector<std::string>> DataDirectory::map_names() const {
  const auto files = file_names(folder_);
  if (!files) return tl::unexpected<Failure>(files.error());
  std::vector<std::string> names;
  for (const std::string& file : *files) {
    const std::string_view suffix = kMapFileSuffix;
    if (!file.ends_with(suffix)) continue;
    std::string name = file.substr(0, file.size() - suffix.size());
    if (protocol::valid_map_name(name)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace earthwork::journal
