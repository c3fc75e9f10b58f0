// An audit names what does not agree with the log, and how far the log is good.
#include "server/journal/audit.hpp"

#include <gtest/gtest.h>

#include "protocol/chunk_record.hpp"
#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

/// Ten events with keyframes at 4 and 8, as this changes them.
Audit audited(const std::function<void(TamperedJournal&)>& tamper) {
  TamperedJournal journal(journal_of(ten_events(), {4, 8}));
  tamper(journal);
  return audit(journal).value();
}

std::vector<std::string> details(const Audit& audit) {
  std::vector<std::string> details;
  for (const auto& finding : audit.findings) {
    EXPECT_EQ(finding.code, Code::damaged);
    details.push_back(finding.detail);
  }
  return details;
}

using Details = std::vector<std::string>;

RC_GTEST_PROP(Audit, FindsNothingInAJournalAsItIsWritten, ()) {
  const auto events = accepted(*some_actions());
  std::vector<std::uint64_t> keyframes;
  for (std::uint64_t seq = 1; seq <= events.size(); ++seq)
    if (*rc::gen::arbitrary<bool>()) keyframes.push_back(seq);
  const auto journal = journal_of(events, keyframes);
  if (*rc::gen::arbitrary<bool>()) RC_ASSERT(journal->tidy(1000).has_value());
  const auto found = audit(*journal);
  RC_ASSERT(found.has_value());
  RC_ASSERT(found->sound());
  RC_ASSERT(found->events == events.size());
  RC_ASSERT(found->hash == (events.empty() ? 0 : events.back().hash));
  RC_ASSERT(found->keyframes == journal->keyframes()->size());
}

TEST(Audit, NamesAHashThatDiffersAndStopsThere) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_event = [](history::Event& event) {
      if (event.seq == 6) event.hash = 0xab;
    };
  });
  EXPECT_EQ(details(found),
            (Details{"events: seq 6: the stored hash is 00000000000000ab, executed it is " +
                     protocol::hex(ten_events()[5].hash)}));
  EXPECT_EQ(found.events, 5u);
  EXPECT_EQ(found.hash, ten_events()[4].hash);
  EXPECT_EQ(found.keyframes, 1u);
}

TEST(Audit, IsGoodUpToTheEventThatCannotBeRead) {
  const Audit found = audited([](TamperedJournal& journal) { journal.unreadable_event = 9; });
  EXPECT_EQ(details(found), Details{"a.earthwork: events: seq 9: sum"});
  EXPECT_EQ(found.events, 8u);
  EXPECT_EQ(found.keyframes, 2u);
}

TEST(Audit, NamesAKeyframeWithAnotherHash) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_keyframes = [](std::vector<Keyframe>& all) { all[1].map_hash = 1; };
  });
  EXPECT_EQ(details(found),
            (Details{"keyframes: seq 8: the stored hash is 0000000000000001, executed it is " +
                     protocol::hex(ten_events()[7].hash)}));
  EXPECT_EQ(found.events, 10u);
  EXPECT_EQ(found.keyframes, 1u);
}

TEST(Audit, NamesAChunkThatDiffers) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_chunk = [](ChunkState& state) {
      if (state.key == voxel::ChunkKey{0, 7, 0, 0}) state.chunk = voxel::Chunk(8);
    };
  });
  EXPECT_EQ(details(found),
            Details{"chunks: seq 7: chunk (0, 7, 0, 0) of keyframe 8 is not what the log gives"});
  EXPECT_EQ(found.keyframes, 1u);
}

TEST(Audit, NamesAChunkOfAnotherAge) {
  const auto aged = [](std::uint64_t seq) {
    return audited([seq](TamperedJournal& journal) {
      journal.change_chunk = [seq](ChunkState& state) {
        if (state.key == voxel::ChunkKey{0, 7, 0, 0}) state.seq = seq;
      };
    });
  };
  EXPECT_EQ(details(aged(6)),
            Details{"chunks: seq 6: chunk (0, 7, 0, 0) of keyframe 8 is from seq 7 by the log"});
  EXPECT_EQ(details(aged(9)),
            Details{"chunks: seq 9: chunk (0, 7, 0, 0) of keyframe 8 is from seq 7 by the log"});
}

TEST(Audit, LetsAChunkBeOlderThanItsStateSays) {
  TamperedJournal journal(journal_of(ten_events(), {10}));
  journal.change_chunk = [](ChunkState& state) { state.seq = 10; };
  EXPECT_TRUE(audit(journal)->sound());
}

TEST(Audit, NamesAChunkThatIsMissing) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_chunks = [](std::vector<ChunkState>& states) {
      std::erase_if(states, [](const ChunkState& state) {
        return state.key == voxel::ChunkKey{0, 7, 0, 0};
      });
    };
  });
  EXPECT_EQ(details(found), Details{"chunks: seq 7: chunk (0, 7, 0, 0) of keyframe 8 is missing"});
}

TEST(Audit, GoesOnAfterAKeyframeThatCannotBeRead) {
  const Audit found = audited([](TamperedJournal& journal) { journal.unreadable_keyframe = 4; });
  EXPECT_EQ(details(found), Details{"a.earthwork: chunks: seq 4: sum"});
  EXPECT_EQ(found.events, 10u);
  EXPECT_EQ(found.keyframes, 1u);
}

TEST(Audit, NamesAnAuthorWithAnotherId) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_authors = [](std::vector<AuthorState>& all) { all[1].applied[0].id = 3; };
  });
  EXPECT_EQ(details(found), Details{"authors: seq 7: the ids of author 00000000000000a1 up to "
                                    "there are not what the log gives"});
  EXPECT_EQ(found.keyframes, 2u);
}

TEST(Audit, NamesAnAuthorWhoIsNotKnownByTheNewestKeyframe) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_authors = [](std::vector<AuthorState>& all) { all.erase(all.begin()); };
  });
  EXPECT_EQ(details(found), Details{"authors: seq 6: author 00000000000000a0 lacks an id that "
                                    "keyframe 8 should have"});
}

TEST(Audit, NamesAnAuthorOfNoEvent) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.change_authors = [](std::vector<AuthorState>& all) { all.push_back({7, {{1, 3}}}); };
  });
  EXPECT_EQ(details(found),
            Details{"authors: seq 3: the log has no such event of author 0000000000000007"});
}

TEST(Audit, FindsOneThingWhenAuthorsCannotBeRead) {
  const Audit found = audited([](TamperedJournal& journal) {
    journal.authors_failure = {Code::damaged, "a.earthwork: authors: seq 3: sum", {}};
  });
  EXPECT_EQ(details(found), Details{"a.earthwork: authors: seq 3: sum"});
}

TEST(Audit, NamesAKeyframeBeyondTheLog) {
  const Audit found = audited([](TamperedJournal& journal) { journal.last = 7; });
  EXPECT_EQ(found.events, 7u);
  ASSERT_FALSE(found.findings.empty());
  EXPECT_EQ(details(found).back(), "keyframes: seq 8: the log has only 7 events");
}

TEST(Audit, NamesAKeyframeWhoseSettingsAreNotTheLogs) {
  auto journal = journal_of(ten_events());
  protocol::MapSettings renamed = small_identity().settings;
  renamed.layers[0].name = "other";
  Execution executed(small_identity().settings);
  for (const auto& event : ten_events()) ASSERT_TRUE(executed.apply(event));
  executed.settings = renamed;
  ASSERT_TRUE(put_whole_keyframe(*journal, executed, 0));
  EXPECT_EQ(details(*audit(*journal)),
            Details{"keyframes: seq 10: its settings are not what the log gives"});
}

TEST(Audit, IsNoneWhenTheDiskFails) {
  TamperedJournal journal(journal_of(ten_events(), {8}));
  journal.keyframes_failure = {Code::storage_failed, "a.earthwork: I/O", {}};
  EXPECT_EQ(audit(journal).error().code, Code::storage_failed);
}

TEST(Audit, BoundsItsFindings) {
  std::vector<protocol::Action> edits(1, disc(0, 0, 100));
  TamperedJournal journal(journal_of(accepted(edits), {1}));
  journal.change_chunk = [](ChunkState& state) { state.chunk = voxel::Chunk(8); };
  EXPECT_EQ(audit(journal)->findings.size(), 100u);
}

}  // namespace
}  // namespace earthwork::journal
