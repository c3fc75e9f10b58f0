#include "server/app/stored_map.hpp"

#include <chrono>
#include <system_error>
#include <utility>

#include "server/app/answer.hpp"
#include "server/journal/map_file.hpp"

namespace earthwork::app {

using journal::DataDirectory;
using protocol::Failure;
using protocol::Result;

Result<void> check_name(const std::string& name) {
  if (protocol::valid_map_name(name)) return {};
  return protocol::fail(protocol::Code::bad_name,
                        "\"" + name + "\" is no name of a map: 1 to 64 of a-z, 0-9, '-', '_'");
}

Result<StoredMap> open_stored_map(const MapFlags& flags) {
  if (auto checked = check_name(flags.name); !checked)
    return tl::unexpected<Failure>(std::move(checked.error()));
  auto folder = DataDirectory::open(flags.data, DataDirectory::Missing::refuse);
  if (!folder) return tl::unexpected<Failure>(std::move(folder.error()));
  auto path = (*folder)->map_file(flags.name);
  auto opened = journal::open_map_file(path, journal::Access::read);
  if (!opened) return tl::unexpected<Failure>(std::move(opened.error()));
  return StoredMap{.folder = std::move(*folder),
                   .name = flags.name,
                   .path = std::move(path),
                   .journal = std::move(*opened)};
}

std::uint64_t file_bytes(const std::filesystem::path& path) {
  std::uint64_t bytes = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code missing;
    const std::uint64_t size = std::filesystem::file_size(path.string() + suffix, missing);
    if (!missing) bytes += size;
  }
  return bytes;
}

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

Result<journal::Restored> salvage(const StoredMap& stored, std::optional<std::uint64_t> seq) {
  auto restored = journal::restore(*stored.journal, seq, journal::Trust::salvage);
  if (!restored || restored->passed_over.empty()) return restored;
  for (const Failure& failure : restored->passed_over) warn("damaged: " + failure.detail);
  warn("executed again from " + std::to_string(restored->keyframe_seq) + ", every hash agreeing");
  return restored;
}

}  // namespace earthwork::app
