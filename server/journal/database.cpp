#include "server/journal/database.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "server/journal/damage.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::Failure;
using protocol::Result;

constexpr int kBusyTimeoutMs = 2000;
// No value of ours is longer, and SQLite allocates nothing longer for a file that says so.
constexpr int kMaxValueBytes = 1 << 20;

Code code_of_errno(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return Code::disk_full;
    case EROFS:
    case EACCES:
    case EPERM:
      return Code::read_only;
    default:
      return Code::storage_failed;
  }
}

Code code_of(int result, int system_error) {
  switch (result & 0xFF) {
    case SQLITE_FULL:
      return Code::disk_full;
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return Code::read_only;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_FORMAT:
    case SQLITE_TOOBIG:
    case SQLITE_ERROR:       // what we ask is right: the schema is not what it was,
    case SQLITE_CONSTRAINT:  // or a row is there that should not
      return Code::damaged;
    case SQLITE_IOERR:
      if (result == SQLITE_IOERR_CORRUPTFS || result == SQLITE_IOERR_SHORT_READ)
        return Code::damaged;
      [[fallthrough]];
    case SQLITE_CANTOPEN:
      return code_of_errno(system_error);
    default:
      return Code::storage_failed;
  }
}

/// The path as part of a URI.
std::string escaped(const std::string& path) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (c != '%' && c != '?' && c != '#')
      out += c;
    else
      (((out += '%') += kDigits[byte >> 4]) += kDigits[byte & 15]);
  }
  return out;
}

/// Asked first, for SQLite opens for reading what it may not write, and says nothing.
Result<void> may_write(const std::filesystem::path& file, const std::string& name) {
  for (const auto& path : {file, file.parent_path()})
    if (::access(path.c_str(), W_OK) != 0) {
      const int error = errno;
      return protocol::fail(code_of_errno(error),
                            name + ": " + std::generic_category().message(error));
    }
  return {};
}

bool has_log(const std::filesystem::path& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path.string() + "-wal", none);
  return !none && size > 0;
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

// Reading must not leave anything behind. Without a log beside it the file is opened as one that
// cannot change, and no log is created; with one, locks are left out and the log's index is kept in
// memory, which exclusive mode does.
Result<Database> Database::open(const std::filesystem::path& path, std::string name, Mode mode) {
  std::error_code error;
  const auto folder =
      std::filesystem::canonical(path.has_parent_path() ? path.parent_path() : ".", error);
  if (error) return protocol::fail(code_of_errno(error.value()), name + ": " + error.message());
  const std::filesystem::path file = folder / path.filename();
  if (mode == Mode::write)
    if (auto may = may_write(file, name); !may) return tl::unexpected<Failure>(may.error());
  std::string target = file.string();
  const Left left = has_log(file) ? Left::log : Left::nothing;
  int flags = SQLITE_OPEN_NOFOLLOW | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  const char* system = nullptr;
  if (mode == Mode::read) {
    flags |= SQLITE_OPEN_READONLY;
    if (left == Left::log) {
      system = "unix-none";
    } else {
      flags |= SQLITE_OPEN_URI;
      target = "file:" + escaped(target) + "?immutable=1";
    }
  } else {
    flags |= SQLITE_OPEN_READWRITE | (mode == Mode::build ? SQLITE_OPEN_CREATE : 0);
  }
  sqlite3* handle = nullptr;
  const int result = sqlite3_open_v2(target.c_str(), &handle, flags, system);
  Database database(handle, std::move(name));
  if (result != SQLITE_OK) return tl::unexpected<Failure>(database.failure(result));
  if (auto configured = database.configure(mode, left); !configured)
    return tl::unexpected<Failure>(std::move(configured.error()));
  return database;
}

// What a crash has left may be all there is of a damaged map: it stays as it is until the map is
// written to.
Result<void> Database::configure(Mode mode, Left left) {
  sqlite3* db = handle();
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 1);
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_busy_timeout(db, kBusyTimeoutMs);
  if (left == Left::log) sqlite3_db_config(db, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  if (mode == Mode::read) {
    return execute("PRAGMA locking_mode=EXCLUSIVE; PRAGMA cell_size_check=ON");
  }
  if (mode == Mode::build) return execute("PRAGMA synchronous=OFF");
  // After a reader that stayed for long, the write-ahead file shrinks again.
  return execute(
      "PRAGMA cell_size_check=ON; PRAGMA synchronous=FULL;"
      "PRAGMA mmap_size=0; PRAGMA journal_size_limit=8388608");
}

void Database::checkpoint_when_closed() {
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
}

Result<void> Database::execute(const char* sql) {
  const int result = sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr);
  if (result != SQLITE_OK) return tl::unexpected<Failure>(failure(result));
  return {};
}

Result<std::int64_t> Database::integer(const char* sql) {
  Statement statement(*this, {}, sql);
  const auto row = statement.begin().next();
  if (!row) return tl::unexpected<Failure>(row.error());
  if (!*row || !statement.row_is("i")) return damaged({}, 0, "an integer is missing");
  return statement.integer(0);
}

// A commit that fails for want of room has not written its last frame, and the frames before it
// count for nothing. When syncing fails, all of them stand in the log: whether they count is known
// once the log was read again.
Result<void> Database::transact(Durable durable, const std::function<Result<void>()>& work) {
  if (durable != durable_) {
    const bool now = durable == Durable::now;
    if (auto set = execute(now ? "PRAGMA synchronous=FULL" : "PRAGMA synchronous=NORMAL"); !set)
      return set;
    durable_ = durable;
  }
  if (auto begun = execute("BEGIN IMMEDIATE"); !begun) return begun;
  Result<void> done = work();
  if (done) {
    const int result = sqlite3_exec(handle(), "COMMIT", nullptr, nullptr, nullptr);
    if (result == SQLITE_OK) return {};
    done = tl::unexpected<Failure>(failure(result));
    doubtful_ = (result & 0xFF) != SQLITE_FULL && (result & 0xFF) != SQLITE_BUSY;
  }
  if (sqlite3_get_autocommit(handle()) == 0 &&
      sqlite3_exec(handle(), "ROLLBACK", nullptr, nullptr, nullptr) != SQLITE_OK)
    doubtful_ = true;
  return done;
}

bool Database::moved() const {
  int moved = 0;
  return sqlite3_file_control(handle(), nullptr, SQLITE_FCNTL_HAS_MOVED, &moved) == SQLITE_OK &&
         moved != 0;
}

Failure Database::failure(int code, std::string_view table) const {
  std::string detail = name_ + ": ";
  if (!table.empty()) (detail += table) += ": ";
  detail += handle() != nullptr ? sqlite3_errmsg(handle()) : sqlite3_errstr(code);
  const int system_error = handle() != nullptr ? sqlite3_system_errno(handle()) : 0;
  return {code_of(code, system_error), std::move(detail), {}};
}

tl::unexpected<Failure> Database::damaged(std::string_view table, std::uint64_t seq,
                                          std::string_view sentence) const {
  return damage(name_, table, seq, sentence);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(const Database& database, std::string_view table, std::string_view sql)
    : database_(database), table_(table) {
  sqlite3_stmt* statement = nullptr;
  result_ = sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()),
                               &statement, nullptr);
  handle_.reset(statement);
}

void Statement::reset() {
  sqlite3_reset(handle_.get());  // what it returns is what `next` has returned already
}

void Statement::bind(int index, std::int64_t value) {
  if (result_ == SQLITE_OK) result_ = sqlite3_bind_int64(handle_.get(), index, value);
}

void Statement::bind(int index, std::string_view text) {
  if (result_ == SQLITE_OK)
    result_ = sqlite3_bind_text64(handle_.get(), index, text.data(), text.size(), SQLITE_STATIC,
                                  SQLITE_UTF8);
}

void Statement::bind(int index, std::span<const std::byte> bytes) {
  static constexpr std::byte kNothing{};  // no bytes are not NULL
  if (result_ == SQLITE_OK)
    result_ = sqlite3_bind_blob64(handle_.get(), index, bytes.empty() ? &kNothing : bytes.data(),
                                  bytes.size(), SQLITE_STATIC);
}

Result<bool> Statement::next() {
  const int result = result_ != SQLITE_OK ? result_ : sqlite3_step(handle_.get());
  if (result == SQLITE_ROW) return true;
  if (result == SQLITE_DONE) return false;
  return tl::unexpected<Failure>(database_.failure(result, table_));
}

bool Statement::row_is(std::string_view types) const {
  if (sqlite3_data_count(handle_.get()) != static_cast<int>(types.size())) return false;
  for (int column = 0; const char type : types) {
    const int found = sqlite3_column_type(handle_.get(), column++);
    if (found != (type == 'i' ? SQLITE_INTEGER : type == 't' ? SQLITE_TEXT : SQLITE_BLOB))
      return false;
  }
  return true;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

std::string_view Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return {text == nullptr ? "" : text,
          static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::span<const std::byte> Statement::bytes(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(handle_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

}  // namespace earthwork::journal
