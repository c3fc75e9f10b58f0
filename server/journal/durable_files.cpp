#include "server/journal/durable_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <system_error>

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::Failure;
using protocol::Result;

constexpr std::string_view kUnfinished = ".unfinished-";

tl::unexpected<Failure> failed(int error, const std::filesystem::path& path) {
  return tl::unexpected<Failure>(system_failure(error, path.filename().string()));
}

Result<void> sync(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) return failed(errno, path);
  const int error = ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  if (error != 0) return failed(error, path);
  return {};
}

}  // namespace

Failure system_failure(int error, const std::string& name) {
  Code code = Code::storage_failed;
  if (error == ENOSPC || error == EDQUOT) code = Code::disk_full;
  if (error == EROFS || error == EACCES || error == EPERM) code = Code::read_only;
  return {code, name + ": " + std::generic_category().message(error), {}};
}

std::filesystem::path unfinished_path(const std::filesystem::path& path) {
  static std::atomic<std::uint64_t> calls{0};
  std::string name = ".";
  name += path.filename().string();
  (name += kUnfinished) += std::to_string(++calls);
  return path.parent_path() / name;
}

bool is_unfinished(std::string_view file_name) {
  return file_name.starts_with('.') && file_name.find(kUnfinished) != std::string_view::npos;
}

Result<void> sync_file(const std::filesystem::path& path) { return sync(path, O_RDONLY); }

Result<void> sync_folder_of(const std::filesystem::path& path) {
  return sync(path.has_parent_path() ? path.parent_path() : ".", O_RDONLY | O_DIRECTORY);
}

Result<void> rename_new(const std::filesystem::path& from, const std::filesystem::path& to) {
  int result = ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  if (result != 0 && errno == EINVAL) {  // a file system that cannot promise it
    std::error_code none;
    if (std::filesystem::exists(std::filesystem::symlink_status(to, none)))
      errno = EEXIST;
    else
      result = ::rename(from.c_str(), to.c_str());
  }
  if (result == 0) return sync_folder_of(to);
  if (errno == EEXIST)
    return protocol::fail(Code::map_exists,
                          to.filename().string() + ": there is a file of that name");
  return failed(errno, to);
}

Result<void> remove_file(const std::filesystem::path& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return {};
  return failed(errno, path);
}

Result<void> remove_companions(const std::filesystem::path& path) {
  for (const char* suffix : {"-wal", "-shm", "-journal", "-tip"})
    if (auto removed = remove_file(path.string() + suffix); !removed) return removed;
  return {};
}

}  // namespace earthwork::journal
