#include "server/journal/tip_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "server/journal/damage.hpp"
#include "server/journal/durable_files.hpp"
#include "server/journal/stored_sum.hpp"

namespace earthwork::journal {
namespace {

using protocol::Failure;
using protocol::Result;

using Words = std::array<std::uint64_t, 3>;

Words words_of(const Tip& tip) {
  return {tip.seq, tip.hash, StoredSum().add(tip.seq).add(tip.hash).value()};
}

bool write_words(int file, const Tip& tip) {
  const Words words = words_of(tip);
  return ::pwrite(file, words.data(), sizeof words, 0) == ssize_t{sizeof words};
}

Result<void> make(const std::filesystem::path& path, const Tip& tip) {
  const auto unfinished = unfinished_path(path);
  const int file = ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return tl::unexpected<Failure>(system_failure(errno, path.filename().string()));
  errno = ENOSPC;  // what writing less than all of it means
  const int error = write_words(file, tip) && ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  if (error == 0 && ::rename(unfinished.c_str(), path.c_str()) == 0) return sync_folder_of(path);
  Failure failure = system_failure(error == 0 ? errno : error, path.filename().string());
  ::unlink(unfinished.c_str());
  return tl::unexpected<Failure>(std::move(failure));
}

}  // namespace

std::filesystem::path tip_path(const std::filesystem::path& map_file) {
  return map_file.string() + "-tip";
}

Result<std::optional<Tip>> read_tip(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return std::nullopt;
  if (file < 0 && errno != ELOOP)
    return tl::unexpected<Failure>(system_failure(errno, path.filename().string()));
  Words words{};
  char more = 0;
  bool whole = file >= 0 && ::read(file, words.data(), sizeof words) == ssize_t{sizeof words};
  whole = whole && ::read(file, &more, 1) == 0;
  if (file >= 0) ::close(file);
  const Tip tip{words[0], words[1]};
  if (whole && words == words_of(tip)) return tip;
  return damage(path.filename().string(), {}, 0,
                "not a tip, so nobody knows whether the log is whole; who removes it takes the log "
                "as it is");
}

Result<TipFile> TipFile::open(const std::filesystem::path& path, const Tip& tip) {
  if (::access(path.c_str(), F_OK) != 0)
    if (auto made = make(path, tip); !made) return tl::unexpected<Failure>(made.error());
  const int file = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return tl::unexpected<Failure>(system_failure(errno, path.filename().string()));
  return TipFile(file);
}

TipFile::~TipFile() {
  if (file_ >= 0) ::close(file_);
}

TipFile::TipFile(TipFile&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

TipFile& TipFile::operator=(TipFile&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

void TipFile::write(const Tip& tip) { write_words(file_, tip); }

}  // namespace earthwork::journal
