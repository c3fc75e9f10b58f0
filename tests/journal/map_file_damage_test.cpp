// Map files with bytes flipped, or cut off: what is read is what was written, or it is said where
// it is not.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <string>
#include <string_view>
#include <vector>

#include "server/journal/audit.hpp"
#include "server/journal/map_file.hpp"
#include "server/journal/restore.hpp"
#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

/// As somebody with the sqlite3 shell.
void change(const std::filesystem::path& path, const char* sql) {
  sqlite3* db = nullptr;
  EXPECT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  EXPECT_GT(sqlite3_changes(db), 0) << sql;
  sqlite3_close(db);
}

bool names_damage(const protocol::Failure& failure) {
  return (failure.code == Code::damaged || failure.code == Code::bad_version) &&
         failure.detail.find("map.earthwork") != std::string::npos;
}

/// Whether all that is read is true: the log is all there, and states that are told are right. A
/// keyframe that is not told any more is made again from the log.
bool same(const Contents& found, const Contents& written) {
  if (found.keyframes.empty() && found.identity == written.identity &&
      found.events == written.events)
    return true;
  return found == written;
}

/// A file that was closed, with two keyframes, of which one is superseded, and events after them.
std::string closed_file(const std::filesystem::path& path, Contents& contents) {
  {
    const auto journal = create_map_file(path, sample_identity()).value();
    SampleLog log;
    log.write(*journal, {3, 9});
    log.put_keyframe(*journal);
    log.write(*journal, {8});
    log.put_keyframe(*journal);
    log.write(*journal, {1, 12, 2});
    contents = contents_of(*journal);
    EXPECT_EQ(contents.failure, std::nullopt);
  }
  return read_bytes(path);
}

/// Opens and reads everything. True when it was found to be damaged.
bool found_out(const std::filesystem::path& path, const Contents& written, Access access,
               const std::string& what) {
  const auto journal = open_map_file(path, access);
  if (!journal) {
    EXPECT_TRUE(names_damage(journal.error())) << what << ": " << journal.error().detail;
    return true;
  }
  const Contents found = contents_of(**journal);
  if (found.failure) {
    EXPECT_TRUE(names_damage(*found.failure)) << what << ": " << found.failure->detail;
    return true;
  }
  EXPECT_TRUE(same(found, written)) << what;
  return false;
}

TEST(MapFileDamage, AFlippedByteIsFoundOrChangesNothing) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  Contents written;
  std::string bytes = closed_file(path, written);
  std::size_t flipped = 0, found = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    // All of what is not free room, and the middle of values less densely.
    if (bytes[at] == 0 && at % 37 != 0) continue;
    if (at % 4096 > 100 && at % 7 != 0) continue;
    for (const char bit : {'\x01', '\x40'}) {
      bytes[at] = static_cast<char>(bytes[at] ^ bit);
      write_bytes(path, bytes);
      bytes[at] = static_cast<char>(bytes[at] ^ bit);
      ++flipped;
      found += found_out(path, written, Access::read, "byte " + std::to_string(at)) ? 1 : 0;
    }
  }
  EXPECT_GT(flipped, 1000u);
  EXPECT_GT(found, flipped / 2);
}

TEST(MapFileDamage, AFileCutOffIsFound) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  Contents written;
  const std::string bytes = closed_file(path, written);
  for (std::size_t size = 0; size < bytes.size(); size += size < 200 ? 7 : 509) {
    for (const Access access : {Access::read, Access::write}) {
      write_bytes(path, bytes.substr(0, size));
      EXPECT_TRUE(found_out(path, written, access, "size " + std::to_string(size))) << size;
      for (const char* suffix : {"-wal", "-shm", "-tip"})
        std::filesystem::remove(path.string() + suffix);
    }
  }
}

/// What a process that is killed leaves: file, write-ahead file and tip.
struct Remains {
  std::string file, wal, tip;
  void lay(const std::filesystem::path& path) const {
    write_bytes(path, file);
    write_bytes(path.string() + "-wal", wal);
    write_bytes(path.string() + "-tip", tip);
    std::filesystem::remove(path.string() + "-shm");
  }
};

Remains remains_of_a_kill(const TemporaryFolder& folder, Contents& contents) {
  const auto path = folder / "live.earthwork";
  const auto journal = create_map_file(path, sample_identity()).value();
  SampleLog log;
  log.write(*journal, {3, 9});
  log.put_keyframe(*journal);
  log.write(*journal, {1, 12, 2});
  contents = contents_of(*journal);
  return {read_bytes(path), read_bytes(path.string() + "-wal"), read_bytes(path.string() + "-tip")};
}

TEST(MapFileDamage, WhatAKillLeavesIsWhole) {
  TemporaryFolder folder;
  Contents written;
  const Remains remains = remains_of_a_kill(folder, written);
  const auto path = folder / "map.earthwork";
  for (const Access access : {Access::read, Access::write}) {
    remains.lay(path);
    EXPECT_FALSE(found_out(path, written, access, "a kill"));
    EXPECT_EQ(read_bytes(path), remains.file);
    EXPECT_EQ(read_bytes(path.string() + "-wal"), remains.wal);
    EXPECT_TRUE(std::filesystem::exists(path.string() + "-tip"));
  }
  remains.lay(path);
  ASSERT_TRUE(open_map_file(path, Access::read));
  EXPECT_EQ(read_bytes(path), remains.file);
  EXPECT_EQ(read_bytes(path.string() + "-wal"), remains.wal);
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-shm"));
}

TEST(MapFileDamage, AWriteAheadFileCutOffIsFound) {
  TemporaryFolder folder;
  Contents written;
  const Remains remains = remains_of_a_kill(folder, written);
  const auto path = folder / "map.earthwork";
  for (std::size_t size = 0; size < remains.wal.size(); size += 1777) {
    for (const Access access : {Access::read, Access::write}) {
      Remains cut = remains;
      cut.wal.resize(size);
      cut.lay(path);
      EXPECT_TRUE(found_out(path, written, access, "size " + std::to_string(size))) << size;
    }
  }
}

TEST(MapFileDamage, AByteFlippedInTheWriteAheadFileIsFoundOrChangesNothing) {
  TemporaryFolder folder;
  Contents written;
  const Remains remains = remains_of_a_kill(folder, written);
  const auto path = folder / "map.earthwork";
  std::size_t found = 0, flipped = 0;
  for (std::size_t at = 0; at < remains.wal.size(); at += at < 200 ? 1 : 211) {
    Remains other = remains;
    other.wal[at] = static_cast<char>(other.wal[at] ^ 4);
    other.lay(path);
    ++flipped;
    found += found_out(path, written, Access::write, "byte " + std::to_string(at)) ? 1 : 0;
  }
  EXPECT_GT(found, flipped / 2);
}

TEST(MapFileDamage, ATipTellsOfEventsThatAreMissing) {
  TemporaryFolder folder;
  Contents written;
  Remains remains = remains_of_a_kill(folder, written);
  const auto path = folder / "map.earthwork";
  remains.wal.clear();
  remains.lay(path);
  const auto refused = open_map_file(path, Access::write);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::damaged);
  EXPECT_NE(refused.error().detail.find("27"), std::string::npos) << refused.error().detail;
  const auto reading = open_map_file(path, Access::read);
  ASSERT_TRUE(reading) << reading.error().detail;
  EXPECT_EQ((*reading)->last_seq(), 27u);
  const auto missing = (*reading)->events(1, 1000);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::damaged);
}

TEST(MapFileDamage, ATipThatIsNoneIsNamed) {
  TemporaryFolder folder;
  Contents written;
  const Remains remains = remains_of_a_kill(folder, written);
  const auto path = folder / "map.earthwork";
  for (std::size_t size = 0; size <= 24; ++size) {
    Remains other = remains;
    size < 24 ? other.tip.resize(size) : static_cast<void>(other.tip += 'x');
    other.lay(path);
    const auto refused = open_map_file(path, Access::write);
    ASSERT_FALSE(refused) << size;
    EXPECT_EQ(refused.error().code, Code::damaged);
    EXPECT_NE(refused.error().detail.find("map.earthwork-tip"), std::string::npos);
  }
  for (std::size_t at = 0; at < 24; ++at) {
    Remains other = remains;
    other.tip[at] = static_cast<char>(other.tip[at] ^ 1);
    other.lay(path);
    EXPECT_FALSE(open_map_file(path, Access::write)) << at;
  }
  std::filesystem::remove(path.string() + "-tip");
  EXPECT_TRUE(open_map_file(path, Access::write)) << "who removes it goes on with what is there";
}

TEST(MapFileDamage, DamageFarBackIsNotServedAndWhatIsSoundCanBeRead) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  {
    const auto journal = create_map_file(path, sample_identity()).value();
    SampleLog log;
    log.write(*journal, {3, 9, 2, 4});
  }
  change(path, "UPDATE events SET hash = hash + 1 WHERE seq = 14");
  const std::string sum_of_13 =
      path.filename().string() + ": batches: seq 13: the sum of events up to 14 is another";
  const std::string bytes = read_bytes(path);
  const auto refused = open_map_file(path, Access::write);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::damaged);
  EXPECT_EQ(refused.error().detail, sum_of_13);
  EXPECT_EQ(read_bytes(path), bytes);

  const auto journal = open_map_file(path, Access::read).value();
  EXPECT_EQ(journal->events(1, 1 << 20).value().size(), 12u);
  EXPECT_EQ(journal->events(15, 1 << 20).value().size(), 4u);
  for (const std::uint64_t from : {13u, 14u}) {
    const auto damaged = journal->events(from, 1 << 20);
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().code, Code::damaged);
    EXPECT_EQ(damaged.error().detail, sum_of_13);
  }
}

// One row of each table changed, or gone, by somebody with the shell: it is named.
TEST(MapFileDamage, AChangedRowIsNamed) {
  struct Case {
    const char *sql, *where;
  };
  for (const Case& c : std::vector<Case>{
           {"UPDATE meta SET value = value || ' ' WHERE key = 'settings'", "meta"},
           {"DELETE FROM meta WHERE key = 'epoch'", "meta"},
           {"INSERT INTO meta VALUES('more', 'x')", "meta"},
           {"UPDATE events SET time_ms = time_ms + 1 WHERE seq = 5", "batches: seq 4"},
           {"UPDATE events SET command = x'00' WHERE seq = 5", "events: seq 5"},
           {"UPDATE events SET kind = 'edit' WHERE seq = 9", "batches: seq 4"},
           {"DELETE FROM events WHERE seq = 5", "events: seq 5"},
           {"DELETE FROM events WHERE seq = 12", "events: seq 12"},
           {"UPDATE batches SET last_seq = 11 WHERE first_seq = 4", "12"},
           {"DELETE FROM batches WHERE first_seq = 1", "batches: seq 1"},
           {"DELETE FROM batches WHERE first_seq = 4", "12"},
           {"UPDATE keyframes SET time_ms = 1", "keyframes: seq 12"},
           {"UPDATE keyframes SET seq = 13", "keyframes: seq 13"},
           {"UPDATE keyframes SET settings = json_set(settings, '$.layers[2].name', 'x')",
            "keyframes: seq 12"},
           {"DELETE FROM chunks WHERE (layer, place) = (SELECT max(layer), min(place) FROM chunks "
            "WHERE layer = 1)",
            "chunks: seq 12"},
           {"UPDATE chunks SET seq = seq - 1 WHERE layer = 1", "chunks: seq "},
           {"UPDATE chunks SET bytes = zeroblob(900000) WHERE layer = 1", "chunks: seq "},
           {"UPDATE chunks SET bytes = zeroblob(2000000) WHERE layer = 1", "chunks: "},
           {"DELETE FROM authors WHERE author = 1", "authors: seq 12"},
           {"UPDATE authors SET ids = x'0101' WHERE author = 2", "authors: "}}) {
    TemporaryFolder folder;
    const auto path = folder / "map.earthwork";
    {
      const auto journal = create_map_file(path, sample_identity()).value();
      SampleLog log;
      log.write(*journal, {3, 9});
      log.put_keyframe(*journal);
    }
    change(path, c.sql);
    const auto journal = open_map_file(path, Access::write);
    const auto failure = journal ? contents_of(**journal).failure : journal.error();
    ASSERT_TRUE(failure) << c.sql;
    EXPECT_EQ(failure->code, Code::damaged) << failure->detail;
    EXPECT_EQ(failure->detail.find("map.earthwork: "), 0u) << failure->detail;
    EXPECT_NE(failure->detail.find(c.where), std::string::npos) << c.sql << ": " << failure->detail;
  }
}

TEST(MapFileDamage, WhatExecutionFindsIsNamedWithTheFile) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  const auto journal = create_map_file(path, sample_identity()).value();
  auto events = SampleLog().more(6);
  events[3].hash ^= 1;
  ASSERT_TRUE(journal->append(0, events));
  const std::string where = "map.earthwork: events: seq 4: the stored hash is ";
  EXPECT_EQ(restore(*journal, {}, Trust::strict).error().detail.find(where), 0u);
  EXPECT_EQ(audit(*journal).value().findings.at(0).detail.find(where), 0u);

  ASSERT_TRUE(
      journal->put_keyframe({.seq = 2, .map_hash = 77, .settings = sample_identity().settings}));
  EXPECT_EQ(
      restore(*journal, 3, Trust::strict).error().detail.find("map.earthwork: keyframes: seq 2"),
      0u);
  EXPECT_EQ(audit(*journal).value().findings.at(0).detail.find("map.earthwork: keyframes: seq 2"),
            0u);
}

// A server would go on trying for ever where it is told that the disk fails.
TEST(MapFileDamage, ARowWhereTheNextOneBelongsIsDamage) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  SampleLog log;
  log.write(*create_map_file(path, sample_identity()).value(), {3, 9});
  change(path, "INSERT INTO batches VALUES(13, 12, 0)");
  const auto journal = open_map_file(path, Access::read).value();
  const auto written = open_map_file(path, Access::write);
  const auto refused = written ? (*written)->append(12, log.more(1))
                               : tl::unexpected<protocol::Failure>(written.error());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::damaged) << refused.error().detail;
}

TEST(MapFileDamage, AForkIsNotMadeOfIdsThatDoNotIncrease) {
  TemporaryFolder folder;
  const auto path = folder / "map.earthwork";
  SampleLog log;
  log.write(*create_map_file(path, sample_identity()).value(), {3, 9, 2});
  change(path, "UPDATE events SET id = 1 WHERE seq = 5");
  const auto refused = fork_map_file(path, folder / "fork.earthwork", 1, 2, 13);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(names_damage(refused.error()) ||
              refused.error().detail.find("fork.earthwork: events: seq 5") == 0)
      << refused.error().detail;
  EXPECT_FALSE(std::filesystem::exists(folder / "fork.earthwork"));
}

}  // namespace
}  // namespace earthwork::journal
