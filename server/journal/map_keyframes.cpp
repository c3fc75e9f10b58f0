#include "server/journal/map_keyframes.hpp"

#include <algorithm>
#include <string>

#include "server/journal/author_ids.hpp"
#include "server/journal/kept_keyframes.hpp"
#include "server/journal/keyframe_row.hpp"
#include "server/journal/settings_text.hpp"
#include "server/journal/stored_sum.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Failure;
using protocol::Result;

constexpr const char* kSelectKeyframes =
    "SELECT seq, map_hash, time_ms, chunks, digest, authors, settings, sum FROM keyframes "
    "WHERE seq >= ? ORDER BY seq";

constexpr std::string_view kKeyframeColumns = "iiiiiiti";

std::uint64_t sum_of(const KeyframeRow& row, std::string_view settings) {
  return StoredSum()
      .add(row.keyframe.seq)
      .add(row.keyframe.map_hash)
      .add(row.keyframe.time_ms)
      .add(row.chunks)
      .add(row.digest)
      .add(row.authors)
      .add(settings)
      .value();
}

std::uint64_t sum_of(std::uint64_t author, std::span<const std::byte> ids) {
  return StoredSum().add(author).add(ids).value();
}

/// Of a statement of kSelectKeyframes, on a row.
Result<KeyframeRow> keyframe_of(const Database& database, const Statement& rows) {
  if (!rows.row_is(kKeyframeColumns) || rows.integer(0) < 1)
    return database.damaged("keyframes", 0, "a row is none of ours");
  KeyframeRow row{.keyframe = {.seq = rows.number(0),
                               .map_hash = rows.number(1),
                               .time_ms = rows.integer(2),
                               .settings = {}},
                  .chunks = rows.number(3),
                  .digest = rows.number(4),
                  .authors = rows.number(5)};
  if (rows.number(7) != sum_of(row, rows.text(6)))
    return database.damaged("keyframes", row.keyframe.seq, "the sum is another");
  auto settings = settings_of(rows.text(6));
  if (!settings)
    return database.damaged("keyframes", row.keyframe.seq, "settings: " + settings.error().detail);
  row.keyframe.settings = std::move(*settings);
  return row;
}

Result<AuthorState> author_of(const Database& database, const Statement& rows) {
  if (!rows.row_is("ibi")) return database.damaged("authors", 0, "a row is none of ours");
  AuthorState state{.author = rows.number(0), .applied = {}};
  auto applied = decode_ids(rows.bytes(1));
  const std::uint64_t last = applied && !applied->empty() ? applied->back().seq : 0;
  if (!applied || rows.number(2) != sum_of(state.author, rows.bytes(1)))
    return database.damaged("authors", last,
                            "author " + std::to_string(rows.integer(0)) + ": the sum is another");
  state.applied = std::move(*applied);
  return state;
}

}  // namespace

Result<KeyframeRow> find_keyframe(Database& database, std::uint64_t seq) {
  Statement find(database, "keyframes", kSelectKeyframes);
  const auto row = find.begin(seq).next();
  if (!row) return tl::unexpected<Failure>(row.error());
  if (*row && find.row_is(kKeyframeColumns) && find.number(0) == seq)
    return keyframe_of(database, find);
  return fail(Code::bad_state,
              database.name() + ": there is no keyframe of event " + std::to_string(seq));
}

Result<void> put_author_rows(Database& database, std::span<const AuthorState> authors) {
  Statement put(database, "authors", "INSERT OR REPLACE INTO authors VALUES(?, ?, ?)");
  for (const AuthorState& author : authors) {
    const std::string ids = encode_ids(author.applied);
    const auto bytes = std::as_bytes(std::span(ids));
    if (auto done = put.run(author.author, bytes, sum_of(author.author, bytes)); !done) return done;
  }
  return {};
}

Result<void> put_keyframe_row(Database& database, const Keyframe& keyframe) {
  const auto newest = newest_keyframe(database);
  if (!newest) return tl::unexpected<Failure>(newest.error());
  KeyframeRow row;
  if (*newest > 0) {
    auto before = find_keyframe(database, *newest);
    if (!before) return tl::unexpected<Failure>(std::move(before.error()));
    row = *before;
  }
  row.keyframe = keyframe;
  const std::string settings = text_of(keyframe.settings);
  if (auto counted = count_chunks(database, *newest, row); !counted) return counted;
  const auto authors = database.integer("SELECT count(*) FROM authors");
  if (!authors) return tl::unexpected<Failure>(authors.error());
  row.authors = static_cast<std::uint64_t>(*authors);
  return Statement(database, "keyframes", "INSERT INTO keyframes VALUES(?, ?, ?, ?, ?, ?, ?, ?)")
      .run(keyframe.seq, keyframe.map_hash, keyframe.time_ms, row.chunks, row.digest, row.authors,
           std::string_view(settings), sum_of(row, settings));
}

Result<std::vector<AuthorState>> read_authors(Database& database) {
  Statement rows(database, "authors", "SELECT author, ids, sum FROM authors ORDER BY author");
  std::vector<AuthorState> authors;
  for (rows.begin();;) {
    const auto more = rows.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) break;
    auto author = author_of(database, rows);
    if (!author) return tl::unexpected<Failure>(std::move(author.error()));
    const auto in_order = [](std::uint64_t a, std::uint64_t b) {
      return static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b);
    };
    if (!authors.empty() && !in_order(authors.back().author, author->author))
      return database.damaged("authors", 0, "a row is not in its place");
    authors.push_back(std::move(*author));
  }
  const auto newest = newest_keyframe(database);
  if (!newest) return tl::unexpected<Failure>(newest.error());
  if (*newest > 0) {
    const auto keyframe = find_keyframe(database, *newest);
    if (!keyframe) return tl::unexpected<Failure>(keyframe.error());
    if (authors.size() < keyframe->authors)
      return database.damaged("authors", *newest, "an author of the keyframe is missing");
  }
  std::sort(authors.begin(), authors.end(),
            [](const auto& a, const auto& b) { return a.author < b.author; });
  return authors;
}

Result<std::vector<Keyframe>> read_keyframes(Database& database) {
  Statement rows(database, "keyframes", kSelectKeyframes);
  std::vector<Keyframe> keyframes;
  for (rows.begin(std::int64_t{INT64_MIN});;) {
    const auto more = rows.next();
    if (!more) return tl::unexpected<Failure>(more.error());
    if (!*more) return keyframes;
    const auto row = keyframe_of(database, rows);
    if (!row) return tl::unexpected<Failure>(row.error());
    if (!keyframes.empty() && row->keyframe.seq <= keyframes.back().seq)
      return database.damaged("keyframes", row->keyframe.seq, "a row is not in its place");
    keyframes.push_back(row->keyframe);
  }
}

Result<std::uint64_t> newest_keyframe(Database& database) {
  Statement newest(database, "keyframes", "SELECT seq FROM keyframes ORDER BY seq DESC LIMIT 1");
  const auto row = newest.begin().next();
  if (!row) return tl::unexpected<Failure>(row.error());
  if (!*row) return 0;
  if (!newest.row_is("i") || newest.integer(0) < 1)
    return database.damaged("keyframes", 0, "the last seq is not a positive integer");
  return newest.number(0);
}

Result<void> drop_keyframes(Database& database) {
  const auto keyframes = read_keyframes(database);
  if (!keyframes) return tl::unexpected<Failure>(keyframes.error());
  std::vector<std::uint64_t> seqs;
  for (const Keyframe& keyframe : *keyframes) seqs.push_back(keyframe.seq);
  const auto kept = kept_keyframes(seqs);
  Statement drop(database, "keyframes", "DELETE FROM keyframes WHERE seq = ?");
  for (const std::uint64_t seq : seqs)
    if (!std::binary_search(kept.begin(), kept.end(), seq))
      if (auto dropped = drop.run(seq); !dropped) return dropped;
  return {};
}

}  // namespace earthwork::journal
