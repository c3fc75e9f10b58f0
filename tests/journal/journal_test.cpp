// What holds of every journal, in memory and on the disk.
#include "server/journal/journal.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/journal/kept_keyframes.hpp"
#include "server/journal/map_file.hpp"
#include "server/journal/memory_journal.hpp"
#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

enum class Form { memory, file };

class AnyJournal : public testing::TestWithParam<Form> {
 protected:
  AnyJournal() {
    if (GetParam() == Form::memory) {
      journal = make_memory_journal(sample_identity());
    } else {
      auto made = create_map_file(folder / "map.earthwork", sample_identity());
      if (made) journal = std::move(*made);
    }
  }
  void SetUp() override { ASSERT_NE(journal, nullptr); }

  TemporaryFolder folder;
  std::unique_ptr<Journal> journal;
  SampleLog log;
};

INSTANTIATE_TEST_SUITE_P(Both, AnyJournal, testing::Values(Form::memory, Form::file),
                         [](const auto& info) {
                           return info.param == Form::memory ? "InMemory" : "OnDisk";
                         });

TEST_P(AnyJournal, BeginsEmptyUnderItsIdentity) {
  EXPECT_EQ(journal->identity(), sample_identity());
  EXPECT_EQ(journal->last_seq(), 0u);
  EXPECT_TRUE(journal->events(1, 1000).value().empty());
  EXPECT_TRUE(journal->keyframes().value().empty());
  EXPECT_TRUE(journal->authors().value().empty());
}

TEST_P(AnyJournal, GivesBackWhatWasAppended) {
  log.write(*journal, {1, 5, 8, 1});
  EXPECT_EQ(journal->last_seq(), 15u);
  const auto events = journal->events(1, 1 << 20).value();
  ASSERT_EQ(events.size(), 15u);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].seq, i + 1);
    EXPECT_EQ(events[i].time_ms, log.events()[i].time_ms);
    EXPECT_EQ(events[i].author, log.events()[i].author);
    EXPECT_EQ(events[i].id, log.events()[i].id);
    EXPECT_EQ(events[i].action, log.events()[i].action);
    EXPECT_EQ(events[i].hash, log.events()[i].hash);
  }
}

TEST_P(AnyJournal, RefusesWhatDoesNotFollow) {
  log.write(*journal, {3});
  SampleLog other;
  const auto again = journal->append(0, other.more(1));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, Code::bad_state);
  static_cast<void>(other.more(3));
  const auto gap = journal->append(4, other.more(1));
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().code, Code::bad_state);
  EXPECT_EQ(journal->last_seq(), 3u);
  log.write(*journal, {1});
  EXPECT_EQ(journal->last_seq(), 4u);
}

TEST_P(AnyJournal, GivesPagesFromAnySeq) {
  log.write(*journal, {4, 4, 4});
  for (std::uint64_t from = 1; from <= 12; ++from) {
    const auto one = journal->events(from, 1).value();
    ASSERT_EQ(one.size(), 1u) << from;
    EXPECT_EQ(one[0].seq, from);
    const auto rest = journal->events(from, 1 << 20).value();
    ASSERT_EQ(rest.size(), 13 - from);
    EXPECT_EQ(rest.back().seq, 12u);
  }
  const auto some = journal->events(2, 500).value();
  EXPECT_GT(some.size(), 1u);
  EXPECT_LT(some.size(), 11u);
  EXPECT_TRUE(journal->events(13, 1000).value().empty());
  EXPECT_EQ(journal->events(0, 1).value().at(0).seq, 1u);
}

std::vector<std::string> lines_of(const std::vector<ChunkState>& states) {
  const auto journal = make_memory_journal(sample_identity());
  SampleLog log;
  log.write(*journal, {40});
  EXPECT_TRUE(journal->put_chunks(states));
  EXPECT_TRUE(journal->put_keyframe({.seq = 40}));
  return chunk_lines(*journal, 40).value();
}

TEST_P(AnyJournal, TellsTheNewestStatesUpToAKeyframe) {
  log.write(*journal, {10});
  log.put_keyframe(*journal);
  const auto first = lines_of(log.states());
  log.write(*journal, {10});
  log.put_keyframe(*journal);
  const auto second = lines_of(log.states());
  ASSERT_NE(first, second);
  EXPECT_EQ(chunk_lines(*journal, 10).value(), first);
  EXPECT_EQ(chunk_lines(*journal, 20).value(), second);
  EXPECT_EQ(journal->authors().value(), log.authors());
  const std::vector<Keyframe> keyframes = journal->keyframes().value();
  ASSERT_EQ(keyframes.size(), 2u);
  EXPECT_EQ(keyframes[1], log.keyframe());
}

TEST_P(AnyJournal, TellsBlankStatesToo) {
  log.write(*journal, {2});
  ASSERT_TRUE(journal->put_chunks(std::vector<ChunkState>{
      {{0, 3, -4, 0}, 1, voxel::Chunk(8)}, {{1, -70000, 70000, 0}, 2, voxel::Chunk(8)}}));
  ASSERT_TRUE(journal->put_keyframe({.seq = 2}));
  EXPECT_EQ(chunk_lines(*journal, 2).value(),
            (std::vector<std::string>{"1 0,3,-4,0 blank", "2 1,-70000,70000,0 blank"}));
}

TEST_P(AnyJournal, KnowsNoStateOfAKeyframeThatWasNotPut) {
  log.write(*journal, {5});
  log.put_keyframe(*journal);
  const auto before = chunk_lines(*journal, 5).value();
  log.write(*journal, {5});
  ASSERT_TRUE(journal->put_chunks(log.states(5)));
  EXPECT_EQ(chunk_lines(*journal, 5).value(), before);
  const auto none = chunk_lines(*journal, 10);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Code::bad_state);
}

TEST_P(AnyJournal, TakesAKeyframeThatIsBegunAgain) {
  log.write(*journal, {5});
  log.put_keyframe(*journal);
  log.write(*journal, {5});
  ASSERT_TRUE(journal->put_chunks(log.states(5)));  // and then nothing comes of it
  log.write(*journal, {5});
  ASSERT_TRUE(journal->put_chunks(log.states(5)));
  ASSERT_TRUE(journal->put_chunks(log.states(5)));
  ASSERT_TRUE(journal->put_authors(log.authors()));
  ASSERT_TRUE(journal->put_keyframe({.seq = 15, .map_hash = log.hash(), .time_ms = 0}));
  EXPECT_EQ(chunk_lines(*journal, 15).value(), lines_of(log.states()));
}

TEST_P(AnyJournal, RefusesStatesAndKeyframesOfOtherTimes) {
  log.write(*journal, {5});
  log.put_keyframe(*journal);
  log.write(*journal, {1});
  for (const std::uint64_t seq : {4u, 5u, 7u}) {
    const std::vector<ChunkState> states{{{0, 0, 0, 0}, seq, voxel::Chunk(8)}};
    const auto put = journal->put_chunks(states);
    ASSERT_FALSE(put) << seq;
    EXPECT_EQ(put.error().code, Code::bad_state);
    const auto keyframe = journal->put_keyframe({.seq = seq});
    ASSERT_FALSE(keyframe) << seq;
    EXPECT_EQ(keyframe.error().code, Code::bad_state);
  }
}

TEST_P(AnyJournal, EndsTellingWhenToldTo) {
  log.write(*journal, {9});
  log.put_keyframe(*journal);
  int told = 0;
  const auto result = journal->chunks(9, [&told](const ChunkState&) -> protocol::Result<void> {
    ++told;
    return protocol::fail(Code::timeout, "enough");
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::timeout);
  EXPECT_EQ(told, 1);
}

TEST_P(AnyJournal, KeepsWhatTheNewestKeyframeNeedsWhenTidied) {
  for (int i = 0; i < 6; ++i) {
    log.write(*journal, {6});
    log.put_keyframe(*journal);
  }
  const auto before = chunk_lines(*journal, 36).value();
  int calls = 1;
  while (!journal->tidy(3).value()) ++calls;
  EXPECT_GT(calls, 2);
  EXPECT_EQ(chunk_lines(*journal, 36).value(), before);
  ASSERT_EQ(journal->keyframes().value().size(), 1u);
  EXPECT_EQ(journal->keyframes().value()[0].seq, 36u);
  EXPECT_FALSE(chunk_lines(*journal, 30));
  EXPECT_TRUE(journal->tidy(1).value());
}

TEST_P(AnyJournal, GoesOnTidyingAfterANewKeyframe) {
  for (int i = 0; i < 12; ++i) {
    log.write(*journal, {3});
    log.put_keyframe(*journal);
    static_cast<void>(journal->tidy(2).value());
    EXPECT_EQ(chunk_lines(*journal, log.last_seq()).value(), lines_of(log.states())) << i;
  }
  while (!journal->tidy(2).value()) {
  }
  EXPECT_EQ(chunk_lines(*journal, 36).value(), lines_of(log.states()));
}

TEST_P(AnyJournal, RemovesUnfinishedStatesWhenTidied) {
  log.write(*journal, {8});
  ASSERT_TRUE(journal->put_chunks(log.states()));
  while (!journal->tidy(2).value()) {
  }
  ASSERT_TRUE(journal->put_keyframe({.seq = 8}));
  EXPECT_TRUE(chunk_lines(*journal, 8).value().empty());
}

TEST(KeptKeyframes, AreTheNewestAndOlderOnesFarApart) {
  using Seqs = std::vector<std::uint64_t>;
  EXPECT_EQ(kept_keyframes({}), Seqs{});
  EXPECT_EQ(kept_keyframes(Seqs{7}), Seqs{7});
  EXPECT_EQ(kept_keyframes(Seqs{7, 65'535}), Seqs{65'535});
  EXPECT_EQ(kept_keyframes(Seqs{65'535, 65'536, 65'537, 131'071, 131'072, 131'080}),
            (Seqs{65'536, 131'072, 131'080}));
}

}  // namespace
}  // namespace earthwork::journal
