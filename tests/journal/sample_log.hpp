// A small log as a room would have written it, and all that a journal holds as one value.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/journal/journal.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::journal {

/// Chunks of 8 x 8, two layers.
Identity sample_identity();

/// Executes edits drawn by lot, and some changes of layers, with the hashes that are true.
class SampleLog {
 public:
  SampleLog();

  const std::vector<history::Event>& events() const { return events_; }
  std::uint64_t last_seq() const { return events_.size(); }
  /// The next `count` events.
  std::vector<history::Event> more(std::size_t count);
  /// Adds batches of these sizes.
  void write(Journal& journal, std::initializer_list<std::size_t> batches);
  /// Puts all chunks that changed since the last keyframe, all authors, and the keyframe.
  void put_keyframe(Journal& journal);

  /// The chunks that ever changed, as they are now.
  std::vector<ChunkState> states(std::uint64_t since = 0) const;
  std::vector<AuthorState> authors() const;
  std::uint64_t hash() { return map_.hash(); }
  const protocol::MapSettings& settings() const { return settings_; }
  /// Of the last event.
  Keyframe keyframe() {
    return {.seq = last_seq(), .map_hash = hash(), .time_ms = 99, .settings = settings_};
  }

 private:
  protocol::MapSettings settings_;
  voxel::Map map_;
  std::vector<history::Event> events_;
  std::vector<std::pair<voxel::ChunkKey, std::uint64_t>> changes_;
  std::uint64_t keyframe_ = 0;
};

/// Everything that a journal tells, in a form that can be compared; failures are the same as
/// nothing, and `failure` is the first of them.
struct Contents {
  std::optional<protocol::Failure> failure;
  Identity identity;
  std::vector<std::string> events, authors, keyframes;
  friend bool operator==(const Contents&, const Contents&) = default;
};
Contents contents_of(Journal& journal);

/// "seq layer,x,y,z hash" of each state.
protocol::Result<std::vector<std::string>> chunk_lines(Journal& journal, std::uint64_t seq);

/// A folder that is gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

}  // namespace earthwork::journal
