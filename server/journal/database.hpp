/// SQLite, as far as map files need it: a connection that trusts no file, statements, transactions,
/// and what SQLite says told as a journal tells it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "protocol/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace earthwork::journal {

/// One connection. One thread at a time.
class Database {
 public:
  enum class Mode {
    write,  ///< Waits 2 s for another program that writes.
    read,   ///< Neither changes nor creates anything, recovery of the log happens in memory. Nobody
            ///< writes meanwhile.
    build,  ///< A file that nobody else knows yet, which is synced as a whole once it is built.
  };
  /// `path` is followed to its folder, and is not a link itself; it need not be there in mode
  /// `build`. `name` is what failures call the file.
  [[nodiscard]] static protocol::Result<Database> open(const std::filesystem::path& path,
                                                       std::string name, Mode mode);

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[nodiscard]] const std::string& name() const { return name_; }

  [[nodiscard]] protocol::Result<void> execute(const char* sql);
  /// One that gives one row with one integer.
  [[nodiscard]] protocol::Result<std::int64_t> integer(const char* sql);

  enum class Durable {
    now,    ///< When it succeeds.
    later,  ///< With the next that is durable now; a loss of power before that takes it as a whole.
  };
  /// Does `work` as a whole or, when it or the commit fails, not at all; unless `doubtful` says
  /// that only opening the file again will tell.
  [[nodiscard]] protocol::Result<void> transact(
      Durable durable, const std::function<protocol::Result<void>()>& work);
  [[nodiscard]] bool doubtful() const { return doubtful_; }

  /// Writes go to a write-ahead file from now on, and the file says so.
  [[nodiscard]] protocol::Result<void> use_log() { return execute("PRAGMA journal_mode=WAL"); }
  /// A write-ahead file that was there before is brought into the file and removed at the end of
  /// the connection, as one is that the connection began; otherwise it stays as it is.
  void checkpoint_when_closed();
  /// Whether the file is not at its path any more.
  [[nodiscard]] bool moved() const;

  /// The failure behind an SQLite result code, just given.
  [[nodiscard]] protocol::Failure failure(int code, std::string_view table = {}) const;
  /// As journal::damage of this file.
  [[nodiscard]] tl::unexpected<protocol::Failure> damaged(std::string_view table, std::uint64_t seq,
                                                          std::string_view sentence) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  Database(sqlite3* handle, std::string name) : handle_(handle), name_(std::move(name)) {}
  /// What lay beside the file when it was opened.
  enum class Left { nothing, log };
  [[nodiscard]] protocol::Result<void> configure(Mode mode, Left left);

  std::unique_ptr<sqlite3, Close> handle_;
  std::string name_;
  bool doubtful_ = false;
  Durable durable_ = Durable::now;  // what commits are now
};

/// A prepared statement of a database, which outlives it. What it cannot do it says when it is run.
class Statement {
 public:
  /// `table` is what its failures name.
  Statement(const Database& database, std::string_view table, std::string_view sql);

  /// Begins anew, with these parameters. Texts and bytes are used until it is begun again.
  template <class... Values>
  Statement& begin(const Values&... values) {
    reset();
    int index = 0;
    (bind(++index, values), ...);
    return *this;
  }
  /// The next row; false when there is none.
  [[nodiscard]] protocol::Result<bool> next();
  /// Begins and finishes one that gives no rows.
  template <class... Values>
  [[nodiscard]] protocol::Result<void> run(const Values&... values) {
    const auto row = begin(values...).next();
    reset();
    if (!row) return tl::unexpected<protocol::Failure>(row.error());
    return {};
  }

  /// Whether the row's columns have these types: i integer, t text, b bytes.
  [[nodiscard]] bool row_is(std::string_view types) const;
  /// Of the row; valid until the next one. Their types have been asked for.
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::uint64_t number(int column) const {
    return static_cast<std::uint64_t>(integer(column));
  }
  [[nodiscard]] std::string_view text(int column) const;
  [[nodiscard]] std::span<const std::byte> bytes(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void reset();
  void bind(int index, std::int64_t value);
  void bind(int index, std::uint64_t value) { bind(index, static_cast<std::int64_t>(value)); }
  void bind(int index, std::string_view text);
  void bind(int index, std::span<const std::byte> bytes);

  const Database& database_;
  std::string_view table_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int result_ = 0;  // of preparing and binding
};

}  // namespace earthwork::journal
