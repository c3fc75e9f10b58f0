#include "server/app/new_file.hpp"

#include <cerrno>
#include <system_error>
#include <utility>

namespace earthwork::app {

using protocol::Code;
using protocol::Result;

NewFile::NewFile(std::filesystem::path path)
    : path_(std::move(path)),
      beside_(path_.string() + ".part"),
      file_(beside_, std::ios::binary | std::ios::trunc),
      open_error_(file_ ? 0 : errno) {}

NewFile::~NewFile() {
  if (beside_.empty()) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(beside_, ignored);
}

Result<void> NewFile::write(std::string_view bytes) {
  if (open_error_ != 0) return failed(open_error_);
  errno = 0;
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) return failed(errno);
  bytes_ += bytes.size();
  return {};
}

Result<void> NewFile::finish() {
  errno = 0;
  file_.close();
  if (!file_) return failed(errno);
  std::error_code error;
  std::filesystem::rename(beside_, path_, error);
  if (error) return failed(error.value());
  beside_.clear();
  return {};
}

tl::unexpected<protocol::Failure> NewFile::failed(int error) const {
  const std::string why =
      error == 0 ? "" : ": " + std::error_code(error, std::generic_category()).message();
  return protocol::fail(error == ENOSPC ? Code::disk_full : Code::storage_failed,
                        path_.string() + " cannot be written" + why);
}

}  // namespace earthwork::app
