#include "server/journal/map_log.hpp"

#include <algorithm>
#include <cassert>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "protocol/json_text.hpp"
#include "server/journal/stored_sum.hpp"

namespace earthwork::journal {
namespace {

using history::Event;
using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;

constexpr std::size_t kMaxCommandBytes = std::size_t{1} << 20;
constexpr std::size_t kEventBytes = 54;  // of a row beside its command, its batch included
constexpr const char* kInsertBatch = "INSERT INTO batches VALUES(?, ?, ?)";

/// A row of events before its command is understood.
struct EventRow {
  Event event;
  std::string_view kind, command;
};

struct BatchRow {
  std::uint64_t first = 0, last = 0, sum = 0;
};

/// The sum of a batch, over its events in order.
class BatchSum {
 public:
  void add(const Event& event, std::string_view kind, std::string_view command) {
    sum_.add(event.seq).add(event.time_ms).add(event.author).add(event.id).add(kind);
    sum_.add(command).add(event.hash);
  }
  void add(const EventRow& row) { add(row.event, row.kind, row.command); }
  std::uint64_t value() const { return sum_.value(); }

 private:
  StoredSum sum_;
};

std::string command_of(const protocol::Action& action) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  protocol::write_fields(action, json);
  return json.dump();
}

Result<protocol::Action> read_command(const Database& database, const EventRow& row) {
  const std::uint64_t seq = row.event.seq;
  const auto json = protocol::parse_json(row.command, kMaxCommandBytes);
  if (!json) return database.damaged("events", seq, "command: " + json.error().detail);
  auto action = protocol::read_action(*json, row.kind);
  if (action) return action;
  if (action.error().code == Code::not_supported)
    return fail(Code::bad_version, database.name() + ": events: seq " + std::to_string(seq) +
                                       ": a command of a kind that this program does not know");
  return database.damaged("events", seq, "command: " + action.error().detail);
}

/// Rows of events from a seq on, which must have no gap.
class EventRows {
 public:
  EventRows(const Database& database, std::uint64_t from)
      : database_(database),
        rows_(database, "events",
              "SELECT seq, time_ms, author, id, kind, command, hash FROM events WHERE seq >= ? "
              "ORDER BY seq"),
        next_(from) {
    rows_.begin(from);
  }

  Result<EventRow> next() {
    const auto row = rows_.next();
    if (!row) return tl::unexpected<Failure>(row.error());
    const std::uint64_t seq = next_++;
    if (!*row || !rows_.row_is("iiiitti") || rows_.number(0) != seq)
      return database_.damaged("events", seq, "the row is missing, or is none of ours");
    return EventRow{.event = {.seq = seq,
                              .time_ms = rows_.integer(1),
                              .author = rows_.number(2),
                              .id = rows_.integer(3),
                              .action = {},
                              .hash = rows_.number(6)},
                    .kind = rows_.text(4),
                    .command = rows_.text(5)};
  }

 private:
  const Database& database_;
  Statement rows_;
  std::uint64_t next_;
};

/// A row of all columns of batches; one without events when it is none of ours.
BatchRow batch_of(const Statement& row) {
  if (!row.row_is("iii")) return {};
  return {.first = row.number(0), .last = row.number(1), .sum = row.number(2)};
}

/// The batch that holds `seq`.
Result<BatchRow> find_batch(const Database& database, std::uint64_t seq) {
  Statement find(database, "batches",
                 "SELECT first_seq, last_seq, sum FROM batches WHERE first_seq <= ? "
                 "ORDER BY first_seq DESC LIMIT 1");
  const auto row = find.begin(seq).next();
  if (!row) return tl::unexpected<Failure>(row.error());
  const BatchRow batch = *row ? batch_of(find) : BatchRow{};
  if (batch.first == 0 || batch.first > seq || batch.last < seq)
    return database.damaged("batches", seq, "no batch holds it");
  return batch;
}

/// What a page has room for.
struct Page {
  std::uint64_t from = 0;
  std::size_t most_bytes = 0, bytes = 0;
  bool full = false;
  std::vector<Event> events;

  bool takes(const EventRow& row) {
    bytes += kEventBytes + row.command.size();
    full = full || (bytes > most_bytes && !events.empty());
    return !full;
  }
};

/// Reads all of a batch and compares its sum; what is on the page stays only if that is right.
Result<void> read_batch(const Database& database, const BatchRow& batch, EventRows& rows,
                        Page& page) {
  BatchSum sum;
  for (std::uint64_t seq = batch.first; seq <= batch.last; ++seq) {
    auto row = rows.next();
    if (!row) return tl::unexpected<Failure>(std::move(row.error()));
    sum.add(*row);
    if (seq < page.from || page.full || !page.takes(*row)) continue;
    auto action = read_command(database, *row);
    if (!action) return tl::unexpected<Failure>(std::move(action.error()));
    row->event.action = std::move(*action);
    page.events.push_back(std::move(row->event));
  }
  if (sum.value() == batch.sum) return {};
  return database.damaged("batches", batch.first,
                          "the sum of events up to " + std::to_string(batch.last) + " is another");
}

Result<std::uint64_t> last_of(Database& database, const char* table, const char* sql) {
  Statement last(database, table, sql);
  const auto row = last.begin().next();
  if (!row) return tl::unexpected<Failure>(row.error());
  if (!*row) return 0;
  if (!last.row_is("i") || last.integer(0) < 1)
    return database.damaged(table, 0, "the last seq is not a positive integer");
  return last.number(0);
}

}  // namespace

Result<void> append_batch(Database& database, std::uint64_t expected_seq,
                          std::span<const Event> events) {
  const auto last = last_event_seq(database);
  if (!last) return tl::unexpected<Failure>(last.error());
  if (*last != expected_seq)
    return fail(Code::bad_state, database.name() + ": the last event is " + std::to_string(*last) +
                                     ", not " + std::to_string(expected_seq));
  Statement insert(database, "events", "INSERT INTO events VALUES(?, ?, ?, ?, ?, ?, ?)");
  BatchSum sum;
  std::uint64_t seq = expected_seq;
  for (const Event& event : events) {
    assert(event.seq == seq + 1);
    seq = event.seq;
    const std::string_view kind = protocol::kind(event.action);
    const std::string command = command_of(event.action);
    if (auto done = insert.run(event.seq, event.time_ms, event.author, event.id, kind,
                               std::string_view(command), event.hash);
        !done)
      return done;
    sum.add(event, kind, command);
  }
  return Statement(database, "batches", kInsertBatch).run(expected_seq + 1, seq, sum.value());
}

Result<std::uint64_t> last_event_seq(Database& database) {
  return last_of(database, "events", "SELECT seq FROM events ORDER BY seq DESC LIMIT 1");
}

Result<std::uint64_t> last_batch_seq(Database& database) {
  return last_of(database, "batches",
                 "SELECT last_seq FROM batches ORDER BY first_seq DESC LIMIT 1");
}

Result<std::optional<std::uint64_t>> event_hash(Database& database, std::uint64_t seq) {
  Statement find(database, "events", "SELECT hash FROM events WHERE seq = ?");
  const auto row = find.begin(seq).next();
  if (!row) return tl::unexpected<Failure>(row.error());
  if (!*row || !find.row_is("i")) return std::nullopt;
  return find.number(0);
}

Result<std::vector<Event>> read_log(Database& database, std::uint64_t from_seq,
                                    std::size_t most_bytes) {
  auto batch = find_batch(database, from_seq);
  if (!batch) return tl::unexpected<Failure>(std::move(batch.error()));
  const auto last = last_event_seq(database);
  if (!last) return tl::unexpected<Failure>(last.error());
  Page page{.from = from_seq, .most_bytes = most_bytes, .events = {}};
  EventRows rows(database, batch->first);
  for (;;) {
    const std::size_t sound = page.events.size();
    auto read = read_batch(database, *batch, rows, page);
    if (read && (page.full || batch->last >= *last)) return std::move(page.events);
    const std::uint64_t next = batch->last + 1;
    if (read) {
      batch = find_batch(database, next);
      if (batch && batch->first == next) continue;
      read = batch ? database.damaged("batches", next, "the batch before it ends elsewhere")
                   : Result<void>(tl::unexpected<Failure>(std::move(batch.error())));
    } else {
      page.events.resize(sound);
    }
    if (page.events.empty()) return tl::unexpected<Failure>(std::move(read.error()));
    return std::move(page.events);
  }
}

Result<void> check_log(Database& database, std::uint64_t last) {
  Statement batches(database, "batches",
                    "SELECT first_seq, last_seq, sum FROM batches ORDER BY first_seq");
  batches.begin();
  EventRows rows(database, 1);
  Page nothing{.full = true, .events = {}};
  for (std::uint64_t next = 1; next <= last;) {
    const auto row = batches.next();
    if (!row) return tl::unexpected<Failure>(row.error());
    const BatchRow batch = *row ? batch_of(batches) : BatchRow{};
    if (batch.first != next || batch.last < next || batch.last > last)
      return database.damaged("batches", next, "no batch begins with it");
    if (auto read = read_batch(database, batch, rows, nothing); !read) return read;
    next = batch.last + 1;
  }
  return {};
}

Result<void> cut_log(Database& database, std::uint64_t seq) {
  const auto last = last_event_seq(database);
  if (!last) return tl::unexpected<Failure>(last.error());
  if (*last <= seq) return {};
  std::optional<BatchRow> rest;
  if (seq > 0) {
    auto batch = find_batch(database, seq);
    if (!batch) return tl::unexpected<Failure>(std::move(batch.error()));
    EventRows checked(database, batch->first), kept(database, batch->first);
    Page none{.full = true, .events = {}};
    if (auto sound = read_batch(database, *batch, checked, none); !sound) return sound;
    BatchSum sum;
    for (std::uint64_t at = batch->first; at <= seq; ++at) {
      const auto row = kept.next();
      if (!row) return tl::unexpected<Failure>(row.error());
      sum.add(*row);
    }
    rest = {.first = batch->first, .last = seq, .sum = sum.value()};
  }
  const std::uint64_t first_gone = rest ? rest->first : 1;
  if (auto d = Statement(database, "events", "DELETE FROM events WHERE seq > ?").run(seq); !d)
    return d;
  if (auto d = Statement(database, "batches", "DELETE FROM batches WHERE first_seq >= ?")
                   .run(first_gone);
      !d || !rest)
    return d;
  return Statement(database, "batches", kInsertBatch).run(rest->first, rest->last, rest->sum);
}

}  // namespace earthwork::journal
