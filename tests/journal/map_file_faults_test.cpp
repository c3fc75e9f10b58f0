// Map files on disks that are full, do not sync, or lose their power: what was acknowledged stays,
// what was refused is not there, and writing goes on when the fault ends.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/journal/map_file.hpp"
#include "tests/journal/fault_vfs.hpp"
#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using Events = std::vector<history::Event>;

/// Writes batches and keyframes until one fails, and remembers what was acknowledged.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& path)
      : journal(create_map_file(path, sample_identity()).value()) {}

  /// True when the batch is there.
  bool append(std::size_t size) {
    if (refused.empty()) refused = log.more(size);
    const auto done = journal->append(refused.front().seq - 1, refused);
    if (!done) {
      failure = done.error();
      return false;
    }
    acknowledged = refused.back().seq;
    refused.clear();
    return true;
  }
  protocol::Result<void> put() {
    auto done = journal->put_chunks(log.states(keyframe));
    if (done) done = journal->put_authors(log.authors());
    if (done)
      done =
          journal->put_keyframe({.seq = acknowledged, .map_hash = 1, .settings = log.settings()});
    if (done) keyframe = acknowledged;
    return done;
  }
  /// Until something fails, or all is done.
  void run() {
    for (const std::size_t size : {1u, 7u, 2u, 30u, 1u, 1u, 60u, 3u}) {
      if (!append(size)) return;
      if (size != 1)
        if (const auto done = put(); !done) {
          failure = done.error();
          return;
        }
    }
  }

  SampleLog log;
  std::unique_ptr<Journal> journal;
  Events refused;  // the batch that failed last
  std::uint64_t acknowledged = 0, keyframe = 0;
  std::optional<protocol::Failure> failure;
};

/// Everything acknowledged is in the journal, as it was; a refused batch is there as a whole or not
/// at all. Gives back the last seq.
std::uint64_t expect_kept(Journal& journal, const Writer& writer) {
  const Contents contents = contents_of(journal);
  EXPECT_EQ(contents.failure, std::nullopt) << contents.failure->detail;
  const std::uint64_t last = journal.last_seq();
  EXPECT_EQ(contents.events.size(), last);
  const std::uint64_t all = writer.refused.empty() ? 0 : writer.refused.back().seq;
  EXPECT_TRUE(last == writer.acknowledged || last == all) << last << " of " << all;
  const Events events = journal.events(1, std::size_t{1} << 24).value();
  for (const auto& event : events)
    EXPECT_EQ(event.hash, writer.log.events().at(event.seq - 1).hash) << event.seq;
  return last;
}

struct FaultCounts {
  std::size_t writes = 0, syncs = 0;
};

/// How often a run without faults writes and syncs.
FaultCounts count_all() {
  TemporaryFolder folder;
  FaultVfs disk;
  Writer writer(folder / "map.earthwork");
  const FaultCounts before{disk.writes(), disk.syncs()};
  writer.run();
  EXPECT_EQ(writer.failure, std::nullopt);
  return {disk.writes() - before.writes, disk.syncs() - before.syncs};
}

TEST(MapFileFaults, AFullDiskRefusesAndRecoversOnTheSameJournal) {
  const std::size_t writes = count_all().writes;
  ASSERT_GT(writes, 40u);
  for (std::size_t at = 1; at <= writes; at += 1 + writes / 60) {
    SCOPED_TRACE(at);
    TemporaryFolder folder;
    FaultVfs disk;
    Writer writer(folder / "map.earthwork");
    disk.fill_disk_at_write(at);
    writer.run();
    ASSERT_TRUE(writer.failure);
    EXPECT_EQ(writer.failure->code, Code::disk_full) << writer.failure->detail;
    EXPECT_EQ(expect_kept(*writer.journal, writer), writer.acknowledged);
    if (!writer.refused.empty()) EXPECT_FALSE(writer.append(0)) << "still full";
    disk.mend();
    EXPECT_TRUE(writer.append(1)) << writer.failure->detail;
    EXPECT_TRUE(writer.append(9));
    EXPECT_TRUE(writer.put());
    expect_kept(*writer.journal, writer);
    writer.journal.reset();
    const auto again = open_map_file(folder / "map.earthwork", Access::write);
    ASSERT_TRUE(again) << again.error().detail;
    EXPECT_EQ(expect_kept(**again, writer), writer.acknowledged);
  }
}

// After a sync that failed nobody knows what is on the disk: a batch that is refused is not there,
// and where that cannot be said the append says so.
TEST(MapFileFaults, AFailedSyncLeavesNoDoubt) {
  const std::size_t syncs = count_all().syncs;
  ASSERT_GE(syncs, 8u);
  for (std::size_t at = 1; at <= syncs; ++at) {
    SCOPED_TRACE(at);
    TemporaryFolder folder;
    FaultVfs disk;
    Writer writer(folder / "map.earthwork");
    disk.fail_at_sync(at);
    writer.run();
    ASSERT_TRUE(writer.failure);
    const bool unknown = writer.failure->code == Code::bad_state;
    EXPECT_TRUE(unknown || writer.failure->code == Code::storage_failed) << writer.failure->detail;
    disk.mend();
    if (unknown) {
      writer.journal.reset();
      writer.journal = open_map_file(folder / "map.earthwork", Access::write).value();
      const std::uint64_t last = expect_kept(*writer.journal, writer);
      if (last != writer.acknowledged) writer.refused.clear();
      writer.acknowledged = last;
    }
    EXPECT_TRUE(writer.append(4)) << writer.failure->detail;
    EXPECT_TRUE(writer.put());
    writer.journal.reset();
    const auto again = open_map_file(folder / "map.earthwork", Access::write);
    ASSERT_TRUE(again) << again.error().detail;
    EXPECT_EQ(expect_kept(**again, writer), writer.acknowledged);
  }
}

// What a kill right after the failure would leave agrees with what was answered.
TEST(MapFileFaults, AfterOneFailedSyncTheFileHoldsWhatTheJournalSays) {
  for (std::size_t at = 1; at <= 6; ++at) {
    SCOPED_TRACE(at);
    TemporaryFolder folder;
    FaultVfs disk;
    Writer writer(folder / "map.earthwork");
    disk.fail_at_sync(at, 1);
    while (writer.append(5) && disk.syncs() < 100) {
    }
    const auto copy = folder / "copy.earthwork";
    for (const char* suffix : {"", "-wal"})
      write_bytes(copy.string() + suffix, read_bytes((folder / "map.earthwork").string() + suffix));
    const auto left = open_map_file(copy, Access::read);
    ASSERT_TRUE(left) << left.error().detail;
    EXPECT_EQ((*left)->last_seq(), writer.journal->last_seq());
    EXPECT_EQ((*left)->last_seq(), writer.acknowledged);
    EXPECT_TRUE(writer.append(1)) << writer.failure->detail;
  }
}

TEST(MapFileFaults, ALossOfPowerTakesNothingThatWasAcknowledged) {
  for (const auto loss : {FaultVfs::Loss::whole, FaultVfs::Loss::torn}) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE(std::to_string(static_cast<int>(loss)) + " " + std::to_string(seed));
      TemporaryFolder folder;
      auto disk = std::make_unique<FaultVfs>();
      disk->watch();
      Writer writer(folder / "map.earthwork");
      // It fails in the middle of something: the disk refuses from some write on, and then is gone.
      disk->fill_disk_at_write(1 + seed * 11 % 150);
      if (seed % 3 == 0) disk->fail_at_sync(1 + seed / 3);
      writer.run();
      disk->lose_power(loss, seed);
      writer.journal.reset();
      disk.reset();
      auto again = open_map_file(folder / "map.earthwork", Access::write);
      ASSERT_TRUE(again) << again.error().detail;
      const std::uint64_t last = expect_kept(**again, writer);
      writer.journal = std::move(*again);
      if (last != writer.acknowledged) writer.refused.clear();
      EXPECT_TRUE(writer.append(2)) << writer.failure->detail;
      expect_kept(*writer.journal, writer);
    }
  }
}

TEST(MapFileFaults, AFullDiskLeavesNoHalfOfANewMap) {
  for (std::size_t at = 1;; ++at) {
    TemporaryFolder folder;
    FaultVfs disk;
    disk.fill_disk_at_write(at);
    const auto made = create_map_file(folder / "map.earthwork", sample_identity());
    if (made) {
      EXPECT_GT(at, 5u);
      return;
    }
    EXPECT_EQ(made.error().code, Code::disk_full) << made.error().detail;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << at;
  }
}

}  // namespace
}  // namespace earthwork::journal
