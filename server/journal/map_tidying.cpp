#include "server/journal/map_tidying.hpp"

#include <sqlite3.h>

#include <algorithm>

#include "server/journal/map_keyframes.hpp"

namespace earthwork::journal {
namespace {

using protocol::Failure;
using protocol::Result;

// Looking at a row costs a fraction of removing one.
constexpr std::size_t kLooksPerRow = 8;

/// The last keyframe before `seq`, 0 without one.
std::uint64_t kept_before(const std::vector<std::uint64_t>& kept, std::uint64_t seq) {
  const auto it = std::lower_bound(kept.begin(), kept.end(), seq);
  return it == kept.begin() ? 0 : *(it - 1);
}

std::size_t changes(const Database& database) {
  return static_cast<std::size_t>(sqlite3_changes(database.handle()));
}

}  // namespace

// A row at seq s makes those of the same chunk between the last keyframe before s and s itself
// superfluous. It must be there itself, not only in the index.
Result<void> MapTidying::remove_superseded(Database& database, Round& round) {
  Statement rows(database, "chunks",
                 "SELECT seq, layer, place FROM chunks INDEXED BY chunks_by_seq "
                 "WHERE (seq, layer, place) > (?1, ?2, ?3) AND seq <= ?4 "
                 "ORDER BY seq, layer, place LIMIT ?5");
  Statement remove(database, "chunks",
                   "DELETE FROM chunks WHERE layer = ?1 AND place = ?2 AND seq > ?3 AND seq < ?4 "
                   "AND EXISTS(SELECT 1 FROM chunks WHERE layer = ?1 AND place = ?2 AND seq = ?4)");
  const std::uint64_t newest = round.kept.back();
  std::vector<Position> page;
  rows.begin(round.at.seq, round.at.layer, round.at.place, newest, std::uint64_t{round.looks_left});
  for (;;) {
    const auto more = rows.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) break;
    if (!rows.row_is("iii")) return database.damaged("chunks", 0, "a row is none of ours");
    page.push_back({rows.number(0), rows.integer(1), rows.integer(2)});
    if (page.back() <= (page.size() > 1 ? page[page.size() - 2] : round.at))
      return database.damaged("chunks", page.back().seq, "a row is not in its place");
  }
  const bool last_page = page.size() < round.looks_left;
  for (const Position& row : page) {
    if (round.rows_left == 0) return {};
    if (auto removed = remove.run(row.layer, row.place, kept_before(round.kept, row.seq), row.seq);
        !removed)
      return removed;
    round.rows_left -= std::min(round.rows_left, changes(database));
    round.at = row;
  }
  round.looks_left -= page.size();
  round.done = last_page;
  return {};
}

Result<void> MapTidying::remove_unfinished(Database& database, Round& round) {
  if (round.rows_left == 0) {
    round.done = false;
    return {};
  }
  Statement remove(database, "chunks",
                   "DELETE FROM chunks WHERE (layer, place, seq) IN (SELECT layer, place, seq "
                   "FROM chunks INDEXED BY chunks_by_seq WHERE seq > ? LIMIT ?)");
  const std::uint64_t newest = round.kept.empty() ? 0 : round.kept.back();
  if (auto removed = remove.run(newest, std::uint64_t{round.rows_left}); !removed) return removed;
  round.done = changes(database) < round.rows_left;
  return {};
}

Result<bool> MapTidying::run(Database& database, std::size_t most) {
  Round round{.kept = {}, .rows_left = most, .looks_left = most * kLooksPerRow, .at = at_};
  auto tidied = database.transact(Database::Durable::later, [&]() -> Result<void> {
    if (auto dropped = drop_keyframes(database); !dropped) return dropped;
    const auto keyframes = read_keyframes(database);
    if (!keyframes) return tl::unexpected<Failure>(keyframes.error());
    for (const auto& keyframe : *keyframes) round.kept.push_back(keyframe.seq);
    round.done = round.kept.empty();
    if (!round.done)
      if (auto removed = remove_superseded(database, round); !removed) return removed;
    if (!round.done) return {};
    return remove_unfinished(database, round);
  });
  if (!tidied) return tl::unexpected<Failure>(std::move(tidied.error()));
  at_ = round.at;
  return round.done;
}

}  // namespace earthwork::journal
