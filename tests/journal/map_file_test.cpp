// Map files: what survives reopening, what people find in them, and what is not one.
#include "server/journal/map_file.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "tests/journal/fault_vfs.hpp"
#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

/// Another program's connection.
class Shell {
 public:
  explicit Shell(const std::filesystem::path& path) {
    EXPECT_EQ(sqlite3_open(path.c_str(), &db_), SQLITE_OK);
  }
  ~Shell() { sqlite3_close(db_); }
  Shell(const Shell&) = delete;
  Shell& operator=(const Shell&) = delete;

  /// The columns of all rows, separated by blanks.
  std::string run(const char* sql) {
    std::string out;
    const auto row = [](void* to, int columns, char** values, char**) {
      for (int i = 0; i < columns; ++i) {
        auto& text = *static_cast<std::string*>(to);
        if (!text.empty()) text += ' ';
        text += values[i] == nullptr ? "NULL" : values[i];
      }
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(db_, sql, row, &out, nullptr), SQLITE_OK) << sqlite3_errmsg(db_);
    return out;
  }

 private:
  sqlite3* db_ = nullptr;
};

class MapFile : public testing::Test {
 protected:
  std::unique_ptr<Journal> create() { return create_map_file(path, sample_identity()).value(); }
  std::unique_ptr<Journal> open(Access access = Access::write) {
    auto opened = open_map_file(path, access);
    EXPECT_TRUE(opened) << opened.error().detail;
    return opened ? std::move(*opened) : nullptr;
  }
  Code refusal(Access access = Access::write) {
    const auto opened = open_map_file(path, access);
    EXPECT_FALSE(opened);
    if (opened) return Code::internal;
    EXPECT_EQ(opened.error().detail.find("map.earthwork: "), 0u) << opened.error().detail;
    EXPECT_EQ(opened.error().detail.find(folder.path().string()), std::string::npos)
        << "clients are not told where files are";
    return opened.error().code;
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      all.push_back(entry.path().filename().string());
    return all;
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder / "map.earthwork";
  SampleLog log;
};

TEST_F(MapFile, SurvivesBeingClosed) {
  Contents before;
  {
    const auto journal = create();
    log.write(*journal, {3, 9});
    log.put_keyframe(*journal);
    log.write(*journal, {2});
    before = contents_of(*journal);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"map.earthwork"}) << "nothing lies beside it";
  for (const Access access : {Access::read, Access::write}) {
    const auto journal = open(access);
    ASSERT_NE(journal, nullptr);
    const Contents after = contents_of(*journal);
    EXPECT_EQ(after.failure, std::nullopt);
    EXPECT_TRUE(after == before);
    EXPECT_EQ(journal->last_seq(), 14u);
  }
  const auto journal = open();
  log.write(*journal, {4});
  EXPECT_EQ(journal->last_seq(), 18u);
}

TEST_F(MapFile, ShowsPeopleWhatIsDocumented) {
  const auto journal = create();
  log.write(*journal, {3, 9});
  log.put_keyframe(*journal);
  Shell shell(path);
  EXPECT_EQ(shell.run("PRAGMA application_id; PRAGMA user_version; PRAGMA journal_mode"),
            "1163357552 1 wal");
  EXPECT_EQ(shell.run("SELECT value FROM meta WHERE key = 'epoch'"), "fedcba9876543210");
  EXPECT_EQ(shell.run("SELECT json_extract(value, '$.layers[1].name') FROM meta "
                      "WHERE key = 'settings'"),
            "ädelsten \"x\"");
  EXPECT_EQ(shell.run("SELECT printf('%016x', author), count(*) FROM events GROUP BY author"),
            "f000000000000001 4 0000000000000001 4 0000000000000002 4");
  EXPECT_EQ(shell.run("SELECT seq, command->>'stencil', command->>'radius', printf('%016x', hash) "
                      "FROM events ORDER BY seq DESC LIMIT 1"),
            "12 circle 1.3 " + protocol::hex(log.hash()));
  EXPECT_EQ(shell.run("SELECT seq, kind, command FROM events WHERE kind <> 'edit'"),
            "9 layer {\"name\":\"três\\\"\",\"wall\":[-2.5,0.1]}");
  EXPECT_EQ(shell.run("SELECT first_seq, last_seq FROM batches"), "1 3 4 12");
  EXPECT_EQ(shell.run("SELECT seq, chunks, authors FROM keyframes"),
            "12 " + std::to_string(log.states().size()) + " 3");
  EXPECT_EQ(shell.run("SELECT json_extract(settings, '$.layers[2].wall') FROM keyframes"),
            "[-2.5,0.1]");
  EXPECT_EQ(shell.run("SELECT count(*) FROM chunks"), std::to_string(log.states().size()));
}

// Keyframes of events 65,536 and 65,900 are kept, that of 65,700 only while it is the newest.
TEST_F(MapFile, KeepsOlderKeyframesFarApartAndNoRowsBeyondTheirNeeds) {
  const auto journal = create();
  auto events = log.more(1);
  events.resize(65'900, events[0]);
  for (std::size_t i = 0; i < events.size(); ++i) events[i].seq = i + 1;
  ASSERT_TRUE(journal->append(0, events));
  const auto put = [&](std::uint64_t keyframe, std::vector<std::uint64_t> seqs) {
    std::vector<ChunkState> states;
    for (const std::uint64_t seq : seqs) states.push_back({{0, 5, 5, 0}, seq, voxel::Chunk(8)});
    ASSERT_TRUE(journal->put_chunks(states));
    ASSERT_TRUE(journal->put_keyframe({.seq = keyframe}));
    while (!journal->tidy(1).value()) {
    }
  };
  put(100, {10});
  put(65'536, {65'500});
  put(65'700, {65'600, 65'650});
  EXPECT_EQ(Shell(path).run("SELECT seq FROM keyframes"), "65536 65700");
  EXPECT_EQ(Shell(path).run("SELECT seq FROM chunks"), "65500 65650");
  put(65'900, {65'800});
  EXPECT_EQ(Shell(path).run("SELECT seq FROM keyframes"), "65536 65900");
  EXPECT_EQ(Shell(path).run("SELECT seq FROM chunks"), "65500 65800");
  EXPECT_EQ(chunk_lines(*journal, 65'536).value(), std::vector<std::string>{"65500 0,5,5,0 blank"});
  EXPECT_EQ(chunk_lines(*journal, 65'900).value(), std::vector<std::string>{"65800 0,5,5,0 blank"});
  ASSERT_TRUE(journal->append(65'900, std::vector{[&] {
                                auto event = events[0];
                                event.seq = 65'901;
                                return event;
                              }()}));
  ASSERT_TRUE(
      journal->put_chunks(std::vector<ChunkState>{{{0, 5, 5, 0}, 65'901, voxel::Chunk(8)}}));
  while (!journal->tidy(1).value()) {
  }
  EXPECT_EQ(Shell(path).run("SELECT seq FROM chunks"), "65500 65800") << "of no keyframe";
}

TEST_F(MapFile, LetsOthersLookWhileItIsWritten) {
  const auto journal = create();
  Shell shell(path);
  log.write(*journal, {3});
  EXPECT_EQ(shell.run("SELECT max(seq) FROM events"), "3");
  log.write(*journal, {2});
  EXPECT_EQ(shell.run("SELECT max(seq) FROM events"), "5");
}

TEST_F(MapFile, RefusesToGoOnWhereSomebodyElseHasWritten) {
  const auto journal = create();
  log.write(*journal, {3});
  Shell(path).run("DELETE FROM events WHERE seq = 3");
  const auto refused = journal->append(3, log.more(1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_state);
}

TEST_F(MapFile, WaitsForNobodyForever) {
  const auto journal = create();
  Shell shell(path);
  shell.run("BEGIN IMMEDIATE");
  const auto events = log.more(1);
  const auto refused = journal->append(0, events);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::storage_failed);
  shell.run("ROLLBACK");
  EXPECT_TRUE(journal->append(0, events));
}

TEST_F(MapFile, IsNotMadeOverAnother) {
  static_cast<void>(create());
  const std::string bytes = read_bytes(path);
  const auto again = create_map_file(path, {});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::map_exists);
  EXPECT_EQ(read_bytes(path), bytes);
  EXPECT_EQ(names().size(), 1u);
}

TEST_F(MapFile, IsNotGivenWhatAnEarlierOneLeft) {
  std::string wal;
  {
    const auto journal = create();
    log.write(*journal, {3});
    wal = read_bytes(path.string() + "-wal");
  }
  ASSERT_TRUE(remove_map_file(path));
  EXPECT_TRUE(names().empty());
  write_bytes(path.string() + "-wal", wal);
  write_bytes(path.string() + "-tip", "of an earlier one");
  const auto journal = create();
  EXPECT_EQ(journal->last_seq(), 0u);
  EXPECT_TRUE(journal->events(1, 1000).value().empty());
}

TEST_F(MapFile, IsRemovedWithAllThatLiesBesideIt) {
  {
    const auto journal = create();
    log.write(*journal, {3});
  }
  write_bytes(path.string() + "-tip", "left");
  write_bytes(folder / "other.earthwork", "another");
  ASSERT_TRUE(remove_map_file(path));
  EXPECT_EQ(names(), std::vector<std::string>{"other.earthwork"});
  const auto again = remove_map_file(path);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::unknown_map);
}

TEST_F(MapFile, IsAFileOfItsOwn) {
  EXPECT_EQ(refusal(), Code::unknown_map);
  std::filesystem::create_directory(path);
  EXPECT_EQ(refusal(), Code::damaged);
  std::filesystem::remove(path);
  ASSERT_TRUE(create_map_file(folder / "real.earthwork", sample_identity()));
  std::filesystem::create_symlink(folder / "real.earthwork", path);
  EXPECT_EQ(refusal(), Code::damaged) << "a link is not followed";
}

TEST_F(MapFile, IsFoundThroughALinkedFolder) {
  static_cast<void>(create());
  std::filesystem::create_directory_symlink(folder.path(), folder / "link");
  EXPECT_TRUE(open_map_file(folder / "link/map.earthwork", Access::write));
  EXPECT_TRUE(open_map_file(folder / "link/map.earthwork", Access::read));
}

TEST_F(MapFile, MayHaveAnyFolderName) {
  std::filesystem::create_directory(folder / "a%20b?c#d 'e");
  path = folder / "a%20b?c#d 'e/map.earthwork";
  static_cast<void>(create());
  ASSERT_NE(open(Access::read), nullptr);
  EXPECT_TRUE(fork_map_file(path, path.parent_path() / "copy.earthwork", 1, 2, {}));
}

TEST_F(MapFile, OfAnotherKindIsRefused) {
  write_bytes(path, std::string(5000, 'x'));
  EXPECT_EQ(refusal(), Code::damaged);
  std::filesystem::remove(path);
  Shell(path).run("CREATE TABLE events(seq)");
  const std::string bytes = read_bytes(path);
  EXPECT_EQ(refusal(), Code::bad_version);
  EXPECT_EQ(read_bytes(path), bytes) << "another program's file stays as it is";
  std::filesystem::remove(path);
  static_cast<void>(create());
  Shell(path).run("PRAGMA user_version = 2");
  EXPECT_EQ(refusal(), Code::bad_version);
  EXPECT_EQ(refusal(Access::read), Code::bad_version);
}

TEST_F(MapFile, OfNoBytesIsDamaged) {
  for (const Access access : {Access::write, Access::read}) {
    write_bytes(path, "");
    EXPECT_EQ(refusal(access), Code::damaged);
    EXPECT_EQ(names(), std::vector<std::string>{"map.earthwork"});
    EXPECT_EQ(read_bytes(path), "");
  }
}

TEST_F(MapFile, IsNotWrittenOnceItWasTakenAway) {
  const auto journal = create();
  log.write(*journal, {3});
  std::filesystem::rename(path, folder / "taken.earthwork");
  const auto gone = journal->append(3, log.more(1));
  ASSERT_FALSE(gone) << "acknowledged, and nowhere to be found";
  EXPECT_EQ(gone.error().code, Code::damaged);
  EXPECT_EQ(gone.error().detail.find("map.earthwork: "), 0u) << gone.error().detail;

  static_cast<void>(create_map_file(folder / "other.earthwork", sample_identity()));
  std::filesystem::rename(folder / "other.earthwork", path);
  const auto replaced = journal->append(3, log.more(1));
  ASSERT_FALSE(replaced);
  EXPECT_EQ(replaced.error().code, Code::damaged);
}

/// Some 40 KB an event.
void write_long_strokes(Journal& journal, SampleLog& log, std::size_t count) {
  const std::uint64_t expected = log.last_seq();
  auto batch = log.more(count);
  for (auto& event : batch) {
    protocol::Edit stroke{.radius = 1, .path = {}, .is_path = true, .stroke = {}};
    stroke.path.assign(1024, {-1000.0 / 7, 1000.0 / 7});
    event.action = std::move(stroke);
  }
  ASSERT_TRUE(journal.append(expected, batch));
}

TEST_F(MapFile, KeepsItsWriteAheadFileShortWhileItIsReadAndWritten) {
  const auto journal = create();
  std::uintmax_t longest = 0;
  for (int i = 0; i < 30; ++i) {
    write_long_strokes(*journal, log, 30);
    EXPECT_FALSE(journal->events(log.last_seq() - 20, 1 << 20).value().empty());
    if (i % 10 == 9) log.put_keyframe(*journal);
    longest = std::max(longest, std::filesystem::file_size(path.string() + "-wal"));
  }
  EXPECT_GT(std::filesystem::file_size(path), std::uintmax_t{20} << 20);
  EXPECT_LT(longest, std::uintmax_t{8} << 20);
}

TEST_F(MapFile, ShrinksItsWriteAheadFileOnceALongReaderIsGone) {
  const auto journal = create();
  const auto wal_bytes = [&] { return std::filesystem::file_size(path.string() + "-wal"); };
  {
    Shell reader(path);
    reader.run("BEGIN; SELECT count(*) FROM events");
    for (int i = 0; i < 4; ++i) write_long_strokes(*journal, log, 100);
    EXPECT_GT(wal_bytes(), std::uintmax_t{10} << 20);
  }
  for (int i = 0; i < 3; ++i) write_long_strokes(*journal, log, 1);
  EXPECT_LE(wal_bytes(), std::uintmax_t{9} << 20);
}

TEST_F(MapFile, WithAnotherSchemaIsRefusedAndNothingOfItRuns) {
  for (const char* sql :
       {"CREATE TRIGGER t AFTER INSERT ON events BEGIN DELETE FROM batches; END",
        "CREATE VIEW v AS SELECT 1", "CREATE TABLE notes(x)", "CREATE INDEX i ON events(author)",
        "DROP TABLE authors", "DROP INDEX chunks_by_seq", "ALTER TABLE events ADD COLUMN more",
        "ALTER TABLE batches RENAME TO b; CREATE VIEW batches AS SELECT * FROM b"}) {
    static_cast<void>(create());
    Shell(path).run(sql);
    EXPECT_EQ(refusal(Access::write), Code::damaged) << sql;
    EXPECT_EQ(refusal(Access::read), Code::damaged) << sql;
    ASSERT_TRUE(remove_map_file(path));
  }
}

TEST_F(MapFile, RefusesACommandOfALaterKind) {
  {
    const auto journal = create();
    log.write(*journal, {1});
  }
  Shell(path).run("UPDATE events SET kind = 'undo'");
  const auto journal = open(Access::read);
  const auto events = journal->events(1, 1000);
  ASSERT_FALSE(events);
  EXPECT_EQ(events.error().code, Code::bad_version);
  EXPECT_NE(events.error().detail.find("seq 1"), std::string::npos);
}

TEST_F(MapFile, IsReadWhereNothingMayBeWritten) {
  static_cast<void>(create());
  const auto journal = open(Access::read);
  const auto refused = journal->append(0, log.more(1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::read_only);
  EXPECT_FALSE(journal->put_keyframe({.seq = 1}));
  EXPECT_FALSE(journal->tidy(1));
}

TEST_F(MapFile, IsOpenedOnAFullDiskAndWrittenWhenThereIsRoom) {
  {
    const auto journal = create();
    log.write(*journal, {5});
  }
  FaultVfs disk;
  disk.fill_disk_at_write(1);
  const auto journal = open();
  ASSERT_NE(journal, nullptr);
  EXPECT_EQ(journal->events(1, 1 << 20).value().size(), 5u);
  const auto events = log.more(2);
  const auto refused = journal->append(5, events);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::disk_full);
  EXPECT_EQ(journal->events(1, 1 << 20).value().size(), 5u);
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-tip")) << "nothing was begun";
  disk.mend();
  EXPECT_TRUE(journal->append(5, events));
  EXPECT_TRUE(std::filesystem::exists(path.string() + "-tip"));
}

TEST_F(MapFile, IsForkedWhole) {
  Contents before;
  {
    const auto journal = create();
    log.write(*journal, {3, 9});
    log.put_keyframe(*journal);
    log.write(*journal, {2});
    before = contents_of(*journal);
  }
  const std::string bytes = read_bytes(path);
  ASSERT_TRUE(fork_map_file(path, folder / "fork.earthwork", 77, 88, {}));
  EXPECT_EQ(read_bytes(path), bytes);
  path = folder / "fork.earthwork";
  const auto fork = open();
  Contents after = contents_of(*fork);
  EXPECT_EQ(after.identity.epoch, 77u);
  EXPECT_EQ(after.identity.created_ms, 88);
  after.identity = before.identity;
  EXPECT_TRUE(after == before);
  log.write(*fork, {3});
  EXPECT_EQ(Shell(path).run("PRAGMA journal_mode"), "wal");
}

TEST_F(MapFile, IsForkedUpToASeq) {
  {
    const auto journal = create();
    log.write(*journal, {3, 9});
    log.put_keyframe(*journal);
    log.write(*journal, {8});
    log.put_keyframe(*journal);
    log.write(*journal, {2});
  }
  for (const std::uint64_t seq : {0u, 2u, 3u, 12u, 15u, 20u, 22u}) {
    SCOPED_TRACE(seq);
    // What a journal says that never went further.
    const auto shorter_path = folder / ("shorter" + std::to_string(seq) + ".earthwork");
    const auto shorter = create_map_file(shorter_path, sample_identity()).value();
    SampleLog shorter_log;
    if (seq > 0) shorter_log.write(*shorter, {std::min<std::size_t>(seq, 12)});
    if (seq >= 12) shorter_log.put_keyframe(*shorter);
    if (seq > 12) shorter_log.write(*shorter, {std::min<std::size_t>(seq, 20) - 12});
    if (seq >= 20) shorter_log.put_keyframe(*shorter);
    if (seq > 20) shorter_log.write(*shorter, {seq - 20});
    ASSERT_TRUE(shorter->put_authors(shorter_log.authors()));

    const auto fork_path = folder / ("fork" + std::to_string(seq) + ".earthwork");
    const Identity identity = sample_identity();
    ASSERT_TRUE(fork_map_file(path, fork_path, identity.epoch, identity.created_ms, seq));
    const auto fork = open_map_file(fork_path, Access::write).value();
    const Contents found = contents_of(*fork);
    EXPECT_EQ(found.failure, std::nullopt);
    EXPECT_TRUE(found == contents_of(*shorter));
    shorter_log.write(*fork, {2});
  }
  const auto beyond = fork_map_file(path, folder / "beyond.earthwork", 1, 2, 23);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, Code::out_of_range);
  const auto taken = fork_map_file(path, folder / "fork2.earthwork", 1, 2, {});
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, Code::map_exists);
  for (const std::string& name : names()) EXPECT_FALSE(name.starts_with('.')) << name;
}

TEST_F(MapFile, TakesNoRoomForWhatAForkLeavesOut) {
  {
    const auto journal = create();
    log.write(*journal, {10, 2000});
  }
  const auto fork = folder / "fork.earthwork", fresh = folder / "fresh.earthwork";
  ASSERT_TRUE(fork_map_file(path, fork, 1, 2, 10));
  SampleLog().write(*create_map_file(fresh, sample_identity()).value(), {10});
  EXPECT_GT(std::filesystem::file_size(path), 3 * std::filesystem::file_size(fresh));
  EXPECT_LE(std::filesystem::file_size(fork), std::filesystem::file_size(fresh) + 4096);
}

TEST_F(MapFile, IsForkedWithWhatACrashLeftInItsWriteAheadFile) {
  const auto journal = create();
  log.write(*journal, {4});
  const auto crashed = folder / "crashed.earthwork";
  for (const char* suffix : {"", "-wal", "-tip"})
    write_bytes(crashed.string() + suffix, read_bytes(path.string() + suffix));
  const auto fork = folder / "fork.earthwork";
  ASSERT_TRUE(fork_map_file(crashed, fork, 1, 2, {}));
  EXPECT_EQ(open_map_file(fork, Access::read).value()->last_seq(), 4u);
  write_bytes(crashed.string() + "-wal", "");
  const auto refused = fork_map_file(crashed, folder / "fork2.earthwork", 1, 2, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::damaged) << "not without what is missing";
  EXPECT_TRUE(fork_map_file(crashed, folder / "fork3.earthwork", 1, 2, 0));
}

}  // namespace
}  // namespace earthwork::journal
