#include "server/journal/map_schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string>

#include "protocol/chunk_record.hpp"
#include "server/journal/settings_text.hpp"
#include "server/journal/stored_sum.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;

// As SQLite keeps the text, so that it can be compared with what is there.
constexpr std::array kSchema = {
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE events(seq INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, author INTEGER NOT "
    "NULL, id INTEGER NOT NULL, kind TEXT NOT NULL, command TEXT NOT NULL, hash INTEGER NOT NULL)",
    "CREATE TABLE batches(first_seq INTEGER PRIMARY KEY, last_seq INTEGER NOT NULL, sum INTEGER "
    "NOT NULL)",
    "CREATE TABLE chunks(layer INTEGER NOT NULL, place INTEGER NOT NULL, seq INTEGER NOT NULL, "
    "bytes BLOB NOT NULL, sum INTEGER NOT NULL, PRIMARY KEY(layer, place, seq)) WITHOUT ROWID",
    "CREATE INDEX chunks_by_seq ON chunks(seq, layer, place)",
    "CREATE TABLE authors(author INTEGER PRIMARY KEY, ids BLOB NOT NULL, sum INTEGER NOT NULL)",
    "CREATE TABLE keyframes(seq INTEGER PRIMARY KEY, map_hash INTEGER NOT NULL, time_ms INTEGER "
    "NOT NULL, chunks INTEGER NOT NULL, digest INTEGER NOT NULL, authors INTEGER NOT NULL, "
    "settings "
    "TEXT NOT NULL, sum INTEGER NOT NULL)",
};

using Values = std::map<std::string, std::string>;

std::string sum_of(const Values& values) {
  StoredSum sum;
  for (const auto& [key, value] : values)
    if (key != "sum") sum.add(std::string_view(key)).add(std::string_view(value));
  return protocol::hex(sum.value());
}

Result<Values> read_values(Database& database) {
  constexpr std::size_t kMostValues = 16;
  Statement rows(database, "meta", "SELECT key, value FROM meta ORDER BY key");
  Values values;
  for (rows.begin();;) {
    const auto row = rows.next();
    if (!row) return tl::unexpected<Failure>(row.error());
    if (!*row) return values;
    if (!rows.row_is("tt") || values.size() == kMostValues)
      return database.damaged("meta", 0, "a row is none of ours");
    values.emplace(rows.text(0), rows.text(1));
  }
}

Result<void> check_numbers(Database& database) {
  const auto application = database.integer("PRAGMA application_id");
  if (!application) return tl::unexpected<Failure>(application.error());
  if (*application != kMapApplicationId)
    return fail(Code::bad_version, database.name() + ": not a map file, by its application_id");
  const auto format = database.integer("PRAGMA user_version");
  if (!format) return tl::unexpected<Failure>(format.error());
  if (*format != kMapFormat)
    return fail(Code::bad_version, database.name() + ": format " + std::to_string(*format) +
                                       ", and this program reads format " +
                                       std::to_string(kMapFormat));
  return {};
}

}  // namespace

Result<void> make_map_schema(Database& database, const Identity& identity) {
  return database.transact(Database::Durable::now, [&]() -> Result<void> {
    for (const char* statement : kSchema)
      if (auto made = database.execute(statement); !made) return made;
    const std::string numbers = "PRAGMA application_id=" + std::to_string(kMapApplicationId) +
                                "; PRAGMA user_version=" + std::to_string(kMapFormat);
    if (auto set = database.execute(numbers.c_str()); !set) return set;
    return write_identity(database, identity);
  });
}

Result<void> check_map_schema(Database& database) {
  if (auto checked = check_numbers(database); !checked) return checked;
  Statement rows(database, "sqlite_schema", "SELECT name, sql FROM sqlite_schema");
  std::size_t found = 0;
  for (rows.begin();; ++found) {
    const auto row = rows.next();
    if (!row) return tl::unexpected<Failure>(row.error());
    if (!*row) break;
    const bool ours = rows.row_is("tt") && found < kSchema.size() &&
                      std::find(kSchema.begin(), kSchema.end(), rows.text(1)) != kSchema.end();
    if (!ours)
      return database.damaged("sqlite_schema", 0,
                              "'" + std::string(rows.text(0)) + "' is none of a map file's tables");
  }
  if (found != kSchema.size()) return database.damaged("sqlite_schema", 0, "a table is missing");
  return {};
}

Result<Identity> read_identity(Database& database) {
  const auto values = read_values(database);
  if (!values) return tl::unexpected<Failure>(values.error());
  const auto value = [&values](const char* key) {
    const auto it = values->find(key);
    return it == values->end() ? std::string() : it->second;
  };
  if (value("sum") != sum_of(*values)) return database.damaged("meta", 0, "the sum is another");
  Identity identity;
  const auto settings = settings_of(value("settings"));
  if (!settings) return database.damaged("meta", 0, "settings: " + settings.error().detail);
  const auto epoch = protocol::parse_hex(value("epoch"));
  if (!epoch) return database.damaged("meta", 0, "epoch: " + epoch.error().detail);
  const std::string created = value("created_ms");
  const auto read =
      std::from_chars(created.data(), created.data() + created.size(), identity.created_ms);
  if (read.ec != std::errc{} || read.ptr != created.data() + created.size())
    return database.damaged("meta", 0, "created_ms: not an integer");
  identity.settings = *settings;
  identity.epoch = *epoch;
  return identity;
}

Result<void> write_identity(Database& database, const Identity& identity) {
  Values values = {{"created_ms", std::to_string(identity.created_ms)},
                   {"epoch", protocol::hex(identity.epoch)},
                   {"settings", text_of(identity.settings)}};
  values["sum"] = sum_of(values);
  Statement put(database, "meta", "INSERT OR REPLACE INTO meta VALUES(?, ?)");
  for (const auto& [key, value] : values)
    if (auto done = put.run(std::string_view(key), std::string_view(value)); !done) return done;
  return {};
}

}  // namespace earthwork::journal
