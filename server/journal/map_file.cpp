#include "server/journal/map_file.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "server/journal/damage.hpp"
#include "server/journal/database.hpp"
#include "server/journal/durable_files.hpp"
#include "server/journal/map_keyframes.hpp"
#include "server/journal/map_log.hpp"
#include "server/journal/map_schema.hpp"
#include "server/journal/map_tidying.hpp"
#include "server/journal/tip_file.hpp"

namespace earthwork::journal {
namespace {

using history::Event;
using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;
using Durable = Database::Durable;

/// Where a log ends, and what says that it should end later.
struct LogEnd {
  std::uint64_t seq = 0;       // of the last event that is there
  std::uint64_t promised = 0;  // of the last that has been there, as far as anything tells
  std::uint64_t hash = 0;      // after `seq`
};

// A reader is told of what is missing when it comes to it, so it takes promises for granted.
Result<LogEnd> find_end(Database& database, const std::optional<Tip>& tip) {
  const auto event = last_event_seq(database);
  if (!event) return tl::unexpected<Failure>(event.error());
  const auto batch = last_batch_seq(database);
  if (!batch) return tl::unexpected<Failure>(batch.error());
  const auto hash = event_hash(database, *event);
  if (!hash) return tl::unexpected<Failure>(hash.error());
  return LogEnd{.seq = *event,
                .promised = std::max({*event, *batch, tip ? tip->seq : 0}),
                .hash = hash->value_or(0)};
}

/// That the log ends where it should, its last batch being sound.
Result<void> check_end(Database& database, const LogEnd& end, const std::optional<Tip>& tip) {
  const auto batch = last_batch_seq(database);
  if (!batch) return tl::unexpected<Failure>(batch.error());
  if (*batch != end.seq)
    return database.damaged("events", std::max(end.seq, *batch),
                            "the last event is " + std::to_string(end.seq) +
                                ", and the last batch ends with " + std::to_string(*batch));
  if (tip && tip->seq > end.seq)
    return database.damaged("events", end.seq + 1,
                            "missing, up to " + std::to_string(tip->seq) +
                                " were there, as the tip beside the file says");
  if (tip && tip->seq > 0) {
    const auto hash = event_hash(database, tip->seq);
    if (!hash) return tl::unexpected<Failure>(hash.error());
    if (*hash != tip->hash)
      return database.damaged("events", tip->seq,
                              "another log's, by the hash in the tip beside the file");
  }
  if (end.seq == 0) return {};
  if (const auto last = read_log(database, end.seq, 1); !last)
    return tl::unexpected<Failure>(last.error());
  return {};
}

class MapFile final : public Journal {
 public:
  MapFile(std::filesystem::path path, Access access)
      : path_(std::move(path)), name_(path_.filename().string()), access_(access) {}
  ~MapFile() override { close(); }

  /// Whether it can be used at all.
  Result<void> open();

  std::string_view name() const override { return name_; }
  const Identity& identity() const override { return identity_; }
  std::uint64_t last_seq() const override { return end_.promised; }

  Result<void> append(std::uint64_t expected_seq, std::span<const Event> events) override;
  Result<std::vector<Event>> events(std::uint64_t from_seq, std::size_t most_bytes) override;
  Result<void> put_chunks(std::span<const ChunkState> states) override;
  Result<void> put_authors(std::span<const AuthorState> authors) override;
  Result<void> put_keyframe(const Keyframe& keyframe) override;
  Result<bool> tidy(std::size_t most) override;
  Result<std::vector<Keyframe>> keyframes() override;
  Result<void> chunks(std::uint64_t seq,
                      const std::function<Result<void>(ChunkState)>& take) override;
  Result<std::vector<AuthorState>> authors() override;

 private:
  [[nodiscard]] Result<void> connect(Database::Mode mode);
  [[nodiscard]] Result<void> to_write();
  [[nodiscard]] Result<void> to_read();
  [[nodiscard]] Result<void> write(Durable durable, const std::function<Result<void>()>& work);
  [[nodiscard]] Result<std::uint64_t> newest() { return newest_keyframe(*database_); }
  [[nodiscard]] Failure look_again(Failure failure);
  void witness();
  void close();

  std::filesystem::path path_;
  std::string name_;
  Access access_;
  Identity identity_;
  bool known_ = false;  // identity_ has been read
  std::optional<Database> database_;
  bool writing_ = false;   // database_ can be written to, and nothing about it is in doubt
  bool in_doubt_ = false;  // what became of the last write is not known
  bool wrote_ = false;     // since it was opened
  LogEnd end_;
  std::optional<TipFile> tip_;
  MapTidying tidying_;
};

Result<void> MapFile::connect(Database::Mode mode) {
  database_.reset();
  writing_ = false;
  auto database = Database::open(path_, name_, mode);
  if (!database) return tl::unexpected<Failure>(std::move(database.error()));
  if (auto checked = check_map_schema(*database); !checked) return checked;
  auto identity = read_identity(*database);
  if (!identity) return tl::unexpected<Failure>(std::move(identity.error()));
  if (mode == Database::Mode::write)
    if (auto log = database->use_log(); !log) return log;
  if (known_ && *identity != identity_)
    return database->damaged("meta", 0, "the file was replaced by another map's");
  const auto tip = read_tip(tip_path(path_));
  if (!tip) return tl::unexpected<Failure>(tip.error());
  auto end = find_end(*database, *tip);
  const bool may_be_damaged = access_ == Access::read;
  if (!end && !(may_be_damaged && end.error().code == Code::damaged))
    return tl::unexpected<Failure>(std::move(end.error()));
  if (!may_be_damaged)
    if (auto checked = check_end(*database, *end, *tip); !checked) return checked;
  identity_ = std::move(*identity);
  known_ = true;
  end_ = end.value_or(LogEnd{.promised = *tip ? (*tip)->seq : 0});
  database_.emplace(std::move(*database));
  if (wrote_) database_->checkpoint_when_closed();
  writing_ = mode == Database::Mode::write;
  return {};
}

// Without room, or where nothing may be written, a map can still be looked at. A log that is
// damaged far back is found here, and not by whoever reads the past some day.
Result<void> MapFile::open() {
  if (access_ == Access::read) return connect(Database::Mode::read);
  auto opened = connect(Database::Mode::write);
  if (!opened && (opened.error().code == Code::disk_full || opened.error().code == Code::read_only))
    opened = connect(Database::Mode::read);
  if (opened) opened = check_log(*database_, end_.seq);
  if (!opened) writing_ = false;
  return opened;
}

Result<void> MapFile::to_write() {
  if (access_ == Access::read) return fail(Code::read_only, name_ + ": opened for reading only");
  if (writing_) return {};
  auto connected = connect(Database::Mode::write);
  if (!connected && !database_)
    if (auto reading = connect(Database::Mode::read); !reading) return reading;
  return connected;
}

Result<void> MapFile::to_read() {
  if (database_) return {};
  return open();
}

/// After a failure in writing: when what became of it is not known, only reading the file anew
/// tells. Where even that fails the next call begins with it.
Failure MapFile::look_again(Failure failure) {
  // Where nothing might be written SQLite has opened it for reading: the next call asks again.
  if (failure.code == Code::read_only) writing_ = false;
  if (!database_->doubtful()) return failure;
  in_doubt_ = !connect(Database::Mode::write) ||
              !database_->execute("PRAGMA wal_checkpoint(TRUNCATE)").has_value();
  if (in_doubt_) writing_ = false;
  return failure;
}

// Only events must be durable at once: states are made again from them, and are synced with the
// next batch.
Result<void> MapFile::write(Durable durable, const std::function<Result<void>()>& work) {
  in_doubt_ = false;
  auto done = database_->transact(durable, work);
  if (!done) return tl::unexpected<Failure>(look_again(std::move(done.error())));
  if (!std::exchange(wrote_, true)) database_->checkpoint_when_closed();
  return done;
}

void MapFile::witness() {
  if (tip_) tip_->write({.seq = end_.seq, .hash = end_.hash});
}

// The tip stays when the write-ahead file does: it may be needed then.
void MapFile::close() {
  const bool settled = database_ && writing_ && !database_->moved();
  database_.reset();
  tip_.reset();
  std::error_code none;
  if (!settled || std::filesystem::exists(path_.string() + "-wal", none)) return;
  static_cast<void>(remove_file(tip_path(path_)));  // an older tip is true as well
}

Result<void> MapFile::append(std::uint64_t expected_seq, std::span<const Event> events) {
  if (auto ready = to_write(); !ready) return ready;
  if (database_->moved())
    return damage(name_, {}, 0, "the file was taken away, or another put in its place");
  if (end_.seq != expected_seq)
    return fail(Code::bad_state, name_ + ": the last event is " + std::to_string(end_.seq) +
                                     ", not " + std::to_string(expected_seq));
  if (!tip_) {
    // What a crash has left beside the file may never have reached the disk.
    if (auto left = database_->execute("PRAGMA wal_checkpoint(PASSIVE)");
        !left && left.error().code != Code::disk_full)
      return left;
    auto tip = TipFile::open(tip_path(path_), {.seq = end_.seq, .hash = end_.hash});
    if (!tip) return tl::unexpected<Failure>(std::move(tip.error()));
    tip_.emplace(std::move(*tip));
  }
  const LogEnd after{
      .seq = events.back().seq, .promised = events.back().seq, .hash = events.back().hash};
  auto done = write(Durable::now, [&] { return append_batch(*database_, expected_seq, events); });
  const bool there_after_all =
      !done && writing_ && end_.seq == after.seq && end_.hash == after.hash;
  if (!done && in_doubt_)
    return fail(Code::bad_state, name_ + ": whether the events up to " + std::to_string(after.seq) +
                                     " are stored is not known: " + done.error().detail);
  if (!done && !there_after_all) return done;
  end_ = after;
  witness();
  return {};
}

Result<std::vector<Event>> MapFile::events(std::uint64_t from_seq, std::size_t most_bytes) {
  if (auto ready = to_read(); !ready) return tl::unexpected<Failure>(std::move(ready.error()));
  from_seq = std::max<std::uint64_t>(from_seq, 1);
  if (from_seq > end_.promised) return std::vector<Event>{};
  if (from_seq > end_.seq)
    return database_->damaged("events", from_seq,
                              "missing; there were events up to " + std::to_string(end_.promised));
  return read_log(*database_, from_seq, most_bytes);
}

Result<void> MapFile::put_chunks(std::span<const ChunkState> states) {
  if (auto ready = to_write(); !ready) return ready;
  const auto since = newest();
  if (!since) return tl::unexpected<Failure>(since.error());
  for (const ChunkState& state : states)
    if (state.seq <= *since || state.seq > end_.seq)
      return fail(Code::bad_state, "a chunk's state of event " + std::to_string(state.seq) +
                                       " belongs to no keyframe to come");
  return write(Durable::later, [&] { return put_chunk_rows(*database_, states); });
}

Result<void> MapFile::put_authors(std::span<const AuthorState> authors) {
  if (auto ready = to_write(); !ready) return ready;
  return write(Durable::later, [&] { return put_author_rows(*database_, authors); });
}

Result<void> MapFile::put_keyframe(const Keyframe& keyframe) {
  if (auto ready = to_write(); !ready) return ready;
  const auto since = newest();
  if (!since) return tl::unexpected<Failure>(since.error());
  if (keyframe.seq <= *since || keyframe.seq > end_.seq)
    return fail(Code::bad_state, "a keyframe of event " + std::to_string(keyframe.seq) +
                                     " cannot follow that of " + std::to_string(*since));
  return write(Durable::later, [&] { return put_keyframe_row(*database_, keyframe); });
}

Result<bool> MapFile::tidy(std::size_t most) {
  if (auto ready = to_write(); !ready) return tl::unexpected<Failure>(std::move(ready.error()));
  auto done = tidying_.run(*database_, std::max<std::size_t>(most, 1));
  if (!done) return tl::unexpected<Failure>(look_again(std::move(done.error())));
  return done;
}

Result<std::vector<Keyframe>> MapFile::keyframes() {
  if (auto ready = to_read(); !ready) return tl::unexpected<Failure>(std::move(ready.error()));
  auto all = read_keyframes(*database_);
  if (all && !all->empty() && all->back().seq > end_.promised)
    return database_->damaged("keyframes", all->back().seq, "beyond the last event");
  return all;
}

Result<void> MapFile::chunks(std::uint64_t seq,
                             const std::function<Result<void>(ChunkState)>& take) {
  if (auto ready = to_read(); !ready) return ready;
  return read_chunks(*database_, identity_.settings.chunk_resolution, seq, take);
}

Result<std::vector<AuthorState>> MapFile::authors() {
  if (auto ready = to_read(); !ready) return tl::unexpected<Failure>(std::move(ready.error()));
  return read_authors(*database_);
}

}  // namespace

Result<std::unique_ptr<Journal>> open_map_file(const std::filesystem::path& path, Access access) {
  const std::string name = path.filename().string();
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    return fail(Code::unknown_map, name + ": there is no such file");
  if (status.type() != std::filesystem::file_type::regular)
    return fail(error ? Code::storage_failed : Code::damaged, name + ": not an ordinary file");
  // SQLite takes it for a database that nothing is in yet.
  if (std::filesystem::file_size(path, error) == 0)
    return fail(Code::damaged, name + ": the file is empty");
  auto file = std::make_unique<MapFile>(path, access);
  if (auto opened = file->open(); !opened)
    return tl::unexpected<Failure>(std::move(opened.error()));
  return file;
}

}  // namespace earthwork::journal
