// Map files come and go as a whole: they are built, or taken apart, under another name.
#include <string>
#include <utility>

#include "server/journal/author_book.hpp"
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
    // They are gone for good before there is a map that they lie beside.
    if (auto synced = sync_folder_of(path_); !synced) return synced;
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
  return Database::open(file.built(), path.filename().string(), Database::Mode::build);
}

Result<void> build_empty(Database database, const Identity& identity) {
  if (auto made = make_map_schema(database, identity); !made) return made;
  return database.use_log();
}

/// What is remembered of the authors after the last event, made from the log.
Result<void> rebuild_authors(Database& database) {
  Statement rows(database, "events", "SELECT seq, author, id FROM events ORDER BY seq");
  AuthorBook book;
  for (rows.begin();;) {
    const auto more = rows.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) break;
    if (!rows.row_is("iii")) return database.damaged("events", 0, "a row is none of ours");
    const std::uint64_t seq = rows.number(0);
    if (!book.add(rows.number(1), {.id = rows.integer(2), .seq = seq}))
      return database.damaged("events", seq, "its id is not above the last of its author");
  }
  if (auto gone = database.execute("DELETE FROM authors"); !gone) return gone;
  return put_author_rows(database, book.states());
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

/// Makes a copy a map of its own.
Result<void> change_copy(const Unfinished& file, const std::filesystem::path& path,
                         std::uint64_t epoch, std::int64_t created_ms) {
  auto database = open_built(file, path);
  if (!database) return tl::unexpected<Failure>(std::move(database.error()));
  auto identity = read_identity(*database);
  if (!identity) return tl::unexpected<Failure>(std::move(identity.error()));
  identity->epoch = epoch;
  identity->created_ms = created_ms;
  if (auto written = database->transact(Database::Durable::now,
                                        [&] { return write_identity(*database, *identity); });
      !written)
    return written;
  return database->use_log();
}

Result<void> copy_whole(const std::filesystem::path& from, const std::string& name,
                        const std::filesystem::path& to) {
  auto source = Database::open(from, name, Database::Mode::read);
  if (!source) return tl::unexpected<Failure>(std::move(source.error()));
  std::error_code error;
  const auto target = std::filesystem::absolute(to, error);
  return Statement(*source, {}, "VACUUM INTO ?").run(std::string_view(target.native()));
}

// What is cut off leaves its room to nobody, so what is left is copied once more.
Result<void> copy_up_to(const std::filesystem::path& from, const std::filesystem::path& to,
                        std::uint64_t seq, const Unfinished& file) {
  const Unfinished longer(to);
  if (auto copied = copy_whole(from, from.filename().string(), longer.built()); !copied)
    return copied;
  {
    auto database = open_built(longer, to);
    if (!database) return tl::unexpected<Failure>(std::move(database.error()));
    if (auto done = database->transact(Database::Durable::now, [&] { return cut(*database, seq); });
        !done)
      return done;
  }
  return copy_whole(longer.built(), to.filename().string(), file.built());
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
  if (auto copied = seq ? copy_up_to(from, to, *seq, file)
                        : copy_whole(from, from.filename().string(), file.built());
      !copied)
    return copied;
  if (auto changed = change_copy(file, to, epoch, created_ms); !changed) return changed;
  return file.finish();
}

Result<void> remove_map_file(const std::filesystem::path& path) {
  std::error_code none;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, none)))
    return fail(Code::unknown_map, path.filename().string() + ": there is no such file");
  const auto gone = unfinished_path(path);
  if (auto renamed = rename_new(path, gone); !renamed) return renamed;
  if (auto removed = remove_companions(path); !removed) return removed;
  if (auto removed = remove_file(gone); !removed) return removed;
  return sync_folder_of(path);
}

}  // namespace earthwork::journal
