#include "server/app/map_import.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "server/app/answer.hpp"
#include "server/app/line_reader.hpp"
#include "server/app/recorded_events.hpp"
#include "server/app/stored_map.hpp"
#include "server/journal/durable_files.hpp"
#include "server/journal/execution.hpp"
#include "server/journal/map_file.hpp"
#include "server/journal/whole_keyframe.hpp"
#include "server/room/entropy.hpp"

namespace earthwork::app {
namespace {

using journal::DataDirectory;
using journal::Journal;
using protocol::Code;
using protocol::Failure;
using protocol::Result;

tl::unexpected<Failure> at_line(std::uint64_t number, Failure failure) {
  failure.detail.insert(0, "line " + std::to_string(number) + ": ");
  return tl::unexpected<Failure>(std::move(failure));
}

/// Events on their way into a journal.
class Import {
 public:
  explicit Import(Journal& journal) : journal_(journal), executed_(journal.identity().settings) {}

  /// Executes the event of a line. Fails with what is wrong with it.
  Result<void> take(std::string_view line) {
    auto recorded = protocol::read_recorded_event(line);
    if (!recorded) return tl::unexpected<Failure>(std::move(recorded.error()));
    if (auto checked = check_action(recorded->action, executed_.settings); !checked) return checked;
    waiting_.push_back(from_recorded(std::move(*recorded)));
    return executed_.apply(waiting_.back());
  }
  [[nodiscard]] bool full() const { return waiting_.size() >= kImportBatch; }
  /// Stores what was taken.
  Result<void> store() {
    if (waiting_.empty()) return {};
    auto appended = journal_.append(waiting_.front().seq - 1, waiting_);
    waiting_.clear();
    return appended;
  }
  Result<void> finish(std::int64_t now) {
    if (auto stored = store(); !stored) return stored;
    return put_whole_keyframe(journal_, executed_, now);
  }
  [[nodiscard]] const journal::Execution& executed() const { return executed_; }

 private:
  Journal& journal_;
  journal::Execution executed_;
  std::vector<history::Event> waiting_;  // executed, not stored yet
};

Result<protocol::RecordingHead> read_head(LineReader& lines) {
  const auto line = lines.next();
  if (!line) return at_line(lines.number(), line.error());
  if (!*line) return protocol::fail(Code::bad_message, "the recording is empty");
  return protocol::read_recording_head(**line).map_error(
      [&lines](Failure failure) { return at_line(lines.number(), std::move(failure)).value(); });
}

/// A map file under a name that no map has; gone at the end. What a kill leaves of it goes when the
/// directory is opened again.
class Draft {
 public:
  explicit Draft(const std::filesystem::path& place) : path_(journal::unfinished_path(place)) {}
  ~Draft() { [[maybe_unused]] const auto nobody_minds = journal::remove_map_file(path_); }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The whole recording in `place`, or nothing.
Result<Imported> import_to(std::istream& recording, const std::filesystem::path& place,
                           std::uint64_t epoch) {
  const Draft draft(place);
  const std::int64_t now = now_ms();
  auto imported = import_recording(
      recording,
      [&](const protocol::MapSettings& settings) {
        return journal::create_map_file(draft.path(),
                                        {.settings = settings, .epoch = epoch, .created_ms = now});
      },
      now);
  if (!imported) return imported;
  imported->journal.reset();
  if (auto forked = journal::fork_map_file(draft.path(), place, epoch, now, {}); !forked)
    return tl::unexpected<Failure>(std::move(forked.error()));
  return imported;
}

}  // namespace

Result<Imported> import_recording(std::istream& recording, const MakeJournal& make_journal,
                                  std::int64_t now) {
  LineReader lines(recording);
  auto head = read_head(lines);
  if (!head) return tl::unexpected<Failure>(std::move(head.error()));
  auto journal = make_journal(head->settings);
  if (!journal) return tl::unexpected<Failure>(std::move(journal.error()));

  Import import(**journal);
  for (;;) {
    const auto line = lines.next();
    if (!line) return at_line(lines.number(), line.error());
    if (!*line) break;
    if (auto taken = import.take(**line); !taken)
      return at_line(lines.number(), std::move(taken.error()));
    if (!import.full()) continue;
    if (auto stored = import.store(); !stored)
      return tl::unexpected<Failure>(std::move(stored.error()));
  }
  if (auto finished = import.finish(now); !finished)
    return tl::unexpected<Failure>(std::move(finished.error()));
  return Imported{import.executed().seq, import.executed().hash, std::move(*journal)};
}

int import_map(const MapFlags& flags) {
  if (const auto checked = check_name(flags.name); !checked) return refuse(checked.error());
  std::ifstream recording(flags.file, std::ios::binary);
  if (!recording) return refuse(kUsage, flags.file + ": cannot be opened");
  const auto folder = DataDirectory::open(flags.data, DataDirectory::Missing::create);
  if (!folder) return refuse(folder.error());
  const auto place = (*folder)->map_file(flags.name);
  std::error_code unknown;
  if (std::filesystem::exists(place, unknown))
    return refuse(kUsage, "there is a map named " + flags.name);

  const std::uint64_t epoch = room::random_u64();
  const auto imported = import_to(recording, place, epoch);
  if (!imported) return refuse(kFailed, flags.file + ": " + imported.error().detail);
  return answer({{"name", flags.name},
                 {"epoch", protocol::hex(epoch)},
                 {"seq", imported->seq},
                 {"hash", protocol::hex(imported->hash)}});
}

}  // namespace earthwork::app
