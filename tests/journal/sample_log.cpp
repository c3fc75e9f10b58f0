#include "tests/journal/sample_log.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "protocol/chunk_record.hpp"
#include "server/history/fold.hpp"

namespace earthwork::journal {

using history::Event;

Identity sample_identity() {
  Identity identity;
  identity.settings.chunk_resolution = 8;
  identity.settings.layers.resize(2);
  identity.settings.layers[1].name = "ädelsten \"x\"";
  identity.epoch = 0xFEDC'BA98'7654'3210;
  identity.created_ms = 1'700'000'000'123;
  return identity;
}

namespace {

/// The ninth event adds a layer, and now and then it is changed.
protocol::LayerChange sample_layer_change(std::uint64_t seq) {
  if (seq == 9) return {.layer = {}, .name = "três\"", .color = {}, .wall = {{-2.5, 0.1}}};
  return {.layer = 2, .name = {}, .color = seq % 2 ? "#0000ff" : "#ff0000", .wall = {}};
}

protocol::Edit sample_edit(std::uint64_t seq) {
  protocol::Edit edit;
  edit.layer = static_cast<std::uint32_t>(seq % 5 == 0);
  edit.fill = seq % 4 != 0;
  edit.radius = 1.3 + static_cast<double>(seq % 3);
  edit.path = {{static_cast<double>(seq * 7 % 31) - 15, static_cast<double>(seq * 3 % 17)}};
  if (seq % 7 == 0) {
    edit.is_path = true;
    edit.path.push_back({0.1, -4.7});
    edit.stroke = 12;
  }
  return edit;
}

protocol::Action sample_action(std::uint64_t seq) {
  if (seq % 17 == 9) return sample_layer_change(seq);
  return sample_edit(seq);
}

}  // namespace

SampleLog::SampleLog()
    : settings_(sample_identity().settings), map_(history::make_map(settings_)) {}

std::vector<Event> SampleLog::more(std::size_t count) {
  std::vector<Event> added;
  for (; added.size() < count; events_.push_back(added.back())) {
    const std::uint64_t seq = last_seq() + 1;
    Event event{.seq = seq,
                .time_ms = 1'700'000'000'000 + static_cast<std::int64_t>(seq) * 17,
                .author = seq % 3 == 0 ? 0xF000'0000'0000'0001 : seq % 3,
                .id = static_cast<std::int64_t>(seq * 5),
                .action = sample_action(seq),
                .hash = 0};
    protocol::apply(event.action, settings_);
    for (const auto& key : history::apply(map_, event.action).changed)
      changes_.push_back({key, seq});
    event.hash = map_.hash();
    added.push_back(event);
  }
  return added;
}

void SampleLog::write(Journal& journal, std::initializer_list<std::size_t> batches) {
  for (const std::size_t size : batches) {
    const std::uint64_t expected = last_seq();
    if (const auto done = journal.append(expected, more(size)); !done)
      throw std::runtime_error(done.error().detail);
  }
}

std::vector<ChunkState> SampleLog::states(std::uint64_t since) const {
  std::map<voxel::ChunkKey, std::uint64_t> last;
  for (const auto& [key, seq] : changes_) last[key] = seq;
  std::vector<ChunkState> states;
  for (const auto& [key, seq] : last) {
    if (seq <= since) continue;
    const voxel::Chunk* chunk = map_.find(key);
    states.push_back({key, seq, chunk != nullptr ? *chunk : voxel::Chunk(8)});
  }
  return states;
}

std::vector<AuthorState> SampleLog::authors() const {
  std::map<std::uint64_t, AuthorState> authors;
  for (const Event& event : events_) {
    authors[event.author].author = event.author;
    authors[event.author].applied.push_back({event.id, event.seq});
  }
  std::vector<AuthorState> all;
  for (const auto& [name, author] : authors) all.push_back(author);
  return all;
}

void SampleLog::put_keyframe(Journal& journal) {
  auto done = journal.put_chunks(states(keyframe_));
  if (done) done = journal.put_authors(authors());
  if (done) done = journal.put_keyframe(keyframe());
  if (!done) throw std::runtime_error(done.error().detail);
  keyframe_ = last_seq();
}

protocol::Result<std::vector<std::string>> chunk_lines(Journal& journal, std::uint64_t seq) {
  std::vector<std::string> lines;
  const auto told = journal.chunks(seq, [&lines](ChunkState state) -> protocol::Result<void> {
    const auto& [layer, x, y, z] = state.key;
    lines.push_back(std::to_string(state.seq) + ' ' + std::to_string(layer) + ',' +
                    std::to_string(x) + ',' + std::to_string(y) + ',' + std::to_string(z) + ' ' +
                    (state.chunk.blank() ? "blank" : protocol::hex(state.chunk.hash())));
    return {};
  });
  if (!told) return tl::unexpected<protocol::Failure>(told.error());
  std::sort(lines.begin(), lines.end());
  return lines;
}

namespace {

std::string line_of(const Event& event) {
  std::string line = std::to_string(event.seq) + ' ' + std::to_string(event.time_ms) + ' ' +
                     std::to_string(event.author) + ' ' + std::to_string(event.id) + ' ' +
                     protocol::hex(event.hash) + ' ';
  nlohmann::ordered_json action;
  protocol::write_action(event.action, action);
  return line + action.dump();
}

void read_events(Journal& journal, Contents& contents) {
  while (contents.events.size() < journal.last_seq() && !contents.failure) {
    const auto page = journal.events(contents.events.size() + 1, 600);
    if (!page)
      contents.failure = page.error();
    else if (page->empty())
      contents.failure = protocol::Failure{protocol::Code::internal, "an empty page", {}};
    else
      for (const Event& event : *page) contents.events.push_back(line_of(event));
  }
}

void read_keyframes(Journal& journal, Contents& contents) {
  const auto keyframes = journal.keyframes();
  if (!keyframes) {
    contents.failure = keyframes.error();
    return;
  }
  for (const Keyframe& keyframe : *keyframes) {
    contents.keyframes.push_back("keyframe " + std::to_string(keyframe.seq) + ' ' +
                                 protocol::hex(keyframe.map_hash) + ' ' +
                                 std::to_string(keyframe.time_ms) + ' ' +
                                 protocol::write_settings(keyframe.settings).dump());
    const auto lines = chunk_lines(journal, keyframe.seq);
    if (!lines) {
      contents.failure = lines.error();
      return;
    }
    contents.keyframes.insert(contents.keyframes.end(), lines->begin(), lines->end());
  }
}

}  // namespace

Contents contents_of(Journal& journal) {
  Contents contents;
  contents.identity = journal.identity();
  read_events(journal, contents);
  if (!contents.failure) read_keyframes(journal, contents);
  if (contents.failure) return contents;
  const auto authors = journal.authors();
  if (!authors) {
    contents.failure = authors.error();
    return contents;
  }
  for (const AuthorState& author : *authors) {
    std::string line = protocol::hex(author.author);
    for (const auto& [id, seq] : author.applied)
      line += ' ' + std::to_string(id) + ':' + std::to_string(seq);
    contents.authors.push_back(line);
  }
  return contents;
}

TemporaryFolder::TemporaryFolder() {
  // In memory where that can be had: what is tried here does not depend on a disk's time.
  const std::filesystem::path memory = "/dev/shm";
  const auto parent =
      ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
  std::string name = (parent / "earthwork-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code none;
  std::filesystem::remove_all(path_, none);
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

}  // namespace earthwork::journal
