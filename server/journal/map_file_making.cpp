// Map files come and go as a whole: they are built, or taken apart, under another name.
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "protocol/limits.hpp"
#include "server/journal/database.hpp"
#include "server/journal/durable_files.hpp"
#include "server/journal/map_file.hpp"
#include "server/journal/map_keyframes.hpp"
#include "server/journal/map_log.hpp"
#include "server/journal/map_schema.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;

/// A file that is built under another name, and gone unless it is given its own.
class Unfinished {
 public:
  explicit Unfinished(const std::filesystem::path& path)
      : path_(path), built_(unfinished_path(path)) {
    remove();
  }
  ~Unfinished() { remove(); }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  const std::filesystem::path& built() const { return built_; }

  // What an earlier map of that name left beside it must not be taken for the new one's.
  Result<void> finish() {
    if (auto synced = sync_file(built_); !synced) return synced;
    std::error_code none;
    if (!std::filesystem::exists(std::filesystem::symlink_status(path_, none)))
      if (auto removed = remove_companions(path_); !removed) return removed;
    return rename_new(built_, path_);
  }

 private:
  void remove() {
    static_cast<void>(remove_file(built_));
    static_cast<void>(remove_companions(built_));
  }

  std::filesystem::path path_, built_;
};

/// The failure names the file that was asked for.
Result<Database> open_built(const Unfinished& file, const std::filesystem::path& path) {
  return Database::open(file.built(), path.string(), Database::Mode::build);
}

Result<void> build_empty(Database database, const Identity& identity) {
  if (auto made = make_map_schema(database, identity); !made) return made;
  return database.execute("PRAGMA journal_mode=WAL");
}

/// What is remembered of the authors after the last event, made from the log.
Result<void> rebuild_authors(Database& database) {
  Statement rows(database, "events", "SELECT seq, author, id FROM events ORDER BY seq");
  std::map<std::uint64_t, AuthorState> authors;
  for (rows.begin();;) {
    const auto more = rows.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) break;
    if (!rows.row_is("iii")) return database.damaged("events", 0, "a row is none of ours");
    AuthorState& author = authors[rows.number(1)];
    author.author = rows.number(1);
    if (author.applied.size() == 2 * protocol::kMaxRememberedIds)
      author.applied.erase(author.applied.begin(),
                           author.applied.end() - protocol::kMaxRememberedIds);
    author.applied.push_back({.id = rows.integer(2), .seq = rows.number(0)});
  }
  std::vector<AuthorState> states;
  for (auto& [name, author] : authors) {
    const std::size_t kept = std::min(author.applied.size(), protocol::kMaxRememberedIds);
    author.applied.erase(author.applied.begin(),
                         author.applied.end() - static_cast<std::ptrdiff_t>(kept));
    states.push_back(std::move(author));
  }
  if (auto gone = database.execute("DELETE FROM authors"); !gone) return gone;
  return put_author_rows(database, states);
}

Result<void> cut(Database& database, std::uint64_t seq) {
  if (auto done = cut_log(database, seq); !done) return done;
  if (auto done = Statement(database, "keyframes", "DELETE FROM keyframes WHERE seq > ?").run(seq);
      !done)
    return done;
  const auto newest = newest_keyframe(database);
  if (!newest) return tl::unexpected<Failure>(newest.error());
  if (auto done = Statement(database, "chunks", "DELETE FROM chunks WHERE seq > ?").run(*newest);
      !done)
    return done;
  return rebuild_authors(database);
}

Result<void> change_copy(Database database, std::uint64_t epoch, std::int64_t created_ms,
                         std::optional<std::uint64_t> seq) {
  auto done = database.transact(Database::Durable::now, [&]() -> Result<void> {
    auto identity = read_identity(database);
    if (!identity) return tl::unexpected<Failure>(std::move(identity.error()));
    identity->epoch = epoch;
    identity->created_ms = created_ms;
    if (auto written = write_identity(database, *identity); !written) return written;
    return seq ? cut(database, *seq) : Result<void>();
  });
  if (!done) return done;
  return database.execute("PRAGMA journal_mode=WAL");
}

Result<void> copy_whole(const std::filesystem::path& from, const std::filesystem::path& to) {
  auto source = Database::open(from, from.string(), Database::Mode::read);
  if (!source) return tl::unexpected<Failure>(std::move(source.error()));
  return Statement(*source, {}, "VACUUM INTO ?").run(std::string_view(to.native()));
}

}  // namespace

Result<std::unique_ptr<Journal>> create_map_file(const std::filesystem::path& path,
                                                 const Identity& identity) {
  Unfinished file(path);
  auto database = open_built(file, path);
  if (!database) return tl::unexpected<Failure>(std::move(database.error()));
  if (auto built = build_empty(std::move(*database), identity); !built)
    return tl::unexpected<Failure>(std::move(built.error()));
  if (auto finished = file.finish(); !finished)
    return tl::unexpected<Failure>(std::move(finished.error()));
  auto opened = open_map_file(path, Access::write);
  if (!opened) static_cast<void>(remove_map_file(path));
  return opened;
}

Result<void> fork_map_file(const std::filesystem::path& from, const std::filesystem::path& to,
                           std::uint64_t epoch, std::int64_t created_ms,
                           std::optional<std::uint64_t> seq) {
  const auto source = open_map_file(from, Access::read);
  if (!source) return tl::unexpected<Failure>(source.error());
  const std::uint64_t last = (*source)->last_seq();
  if (seq && *seq > last)
    return fail(Code::out_of_range, "seq: " + std::to_string(*seq) + " is after the last event, " +
                                        std::to_string(last));
  // What is copied is there: also the last event, or the one that the copy ends with.
  if (const std::uint64_t end = seq.value_or(last); end > 0)
    if (const auto found = (*source)->events(end, 1); !found)
      return tl::unexpected<Failure>(found.error());
  Unfinished file(to);
  std::error_code error;
  const auto folder = std::filesystem::absolute(file.built(), error);
  if (auto copied = copy_whole(from, folder); !copied) return copied;
  auto database = open_built(file, to);
  if (!database) return tl::unexpected<Failure>(std::move(database.error()));
  if (auto changed = change_copy(std::move(*database), epoch, created_ms, seq); !changed)
    return changed;
  return file.finish();
}

Result<void> remove_map_file(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, none)))
    return fail(Code::unknown_map, path.string() + ": there is no such file");
  const auto gone = unfinished_path(path);
  if (auto renamed = rename_new(path, gone); !renamed) return renamed;
  if (auto removed = remove_companions(path); !removed) return removed;
  if (auto removed = remove_file(gone); !removed) return removed;
  return sync_folder_of(path);
}

}  // namespace earthwork::journal
