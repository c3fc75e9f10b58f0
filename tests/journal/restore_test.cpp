// A map from its journal: the same from wherever it starts, and never from what is damaged.
#include "server/journal/restore.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "protocol/chunk_record.hpp"
#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

/// What folding the first `seq` events gives.
Execution folded(const std::vector<history::Event>& events, std::uint64_t seq) {
  Execution executed(small_identity().settings);
  for (const history::Event& event : events)
    if (event.seq <= seq) RC_ASSERT(executed.apply(event).has_value());
  return executed;
}

std::vector<std::uint64_t> some_keyframes(std::size_t events) {
  std::vector<std::uint64_t> seqs;
  for (std::uint64_t seq = 1; seq <= events; ++seq)
    if (*rc::gen::weightedElement<bool>({{1, true}, {3, false}})) seqs.push_back(seq);
  return seqs;
}

RC_GTEST_PROP(Restore, GivesTheFoldOfTheEventsAtAnySeq, ()) {
  const auto events = accepted(*some_actions());
  const auto journal = journal_of(events, some_keyframes(events.size()));
  const auto seq = *rc::gen::inRange<std::uint64_t>(0, events.size() + 1);

  const auto restored = restore(*journal, seq, Trust::strict);
  RC_ASSERT(restored.has_value());
  Execution expected = folded(events, seq);
  RC_ASSERT(restored->seq == seq);
  RC_ASSERT(restored->hash == expected.map.hash());
  RC_ASSERT(restored->settings == expected.settings);
  RC_ASSERT(restored->map.grid().layers == static_cast<int>(expected.settings.layers.size()));
  RC_ASSERT(restored->map.keys() == expected.map.keys());
  RC_ASSERT(restored->ages == expected.ages.in_order());
  RC_ASSERT(restored->authors == expected.authors.states());
  RC_ASSERT(restored->passed_over.empty());
}

RC_GTEST_PROP(Restore, StartsFromTheNewestKeyframeUpToTheSeq, ()) {
  const auto events = accepted(*some_actions());
  const auto keyframes = some_keyframes(events.size());
  const auto journal = journal_of(events, keyframes);
  const auto seq = *rc::gen::inRange<std::uint64_t>(0, events.size() + 1);
  std::uint64_t newest = 0;
  for (const std::uint64_t keyframe : keyframes)
    if (keyframe <= seq) newest = keyframe;
  RC_ASSERT(restore(*journal, seq, Trust::strict)->keyframe_seq == newest);
}

TEST(Restore, IsAsOfTheLastEventWithoutASeq) {
  const auto events = ten_events();
  const auto restored = restore(*journal_of(events, {4}), {}, Trust::strict);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->seq, 10u);
  EXPECT_EQ(restored->hash, events.back().hash);
  EXPECT_EQ(restored->keyframe_seq, 4u);
}

TEST(Restore, TellsTheAgesOfChunksThatAreGone) {
  const auto restored = restore(*journal_of(ten_events(), {10}), {}, Trust::strict);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->map.find({0, 3, 0, 0}), nullptr);
  const auto gone = std::ranges::find(restored->ages, voxel::ChunkKey{0, 3, 0, 0}, &ChunkAge::key);
  ASSERT_NE(gone, restored->ages.end());
  EXPECT_EQ(gone->seq, 10u);
}

TEST(Restore, OfAnEmptyJournalIsAnEmptyMap) {
  const auto restored = restore(*journal_of({}), {}, Trust::strict);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->seq, 0u);
  EXPECT_EQ(restored->map.chunk_count(), 0u);
  EXPECT_TRUE(restored->authors.empty());
}

TEST(Restore, DoesNotReachPastTheLastEvent) {
  const auto journal = journal_of(ten_events());
  const auto beyond = restore(*journal, 11, Trust::salvage);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, Code::out_of_range);
  EXPECT_EQ(beyond.error().detail, "seq: 11 is beyond the last one, 10");
}

TEST(Restore, ReadsTheLogInPages) {
  protocol::Edit edit = disc(0, 0, 1);
  edit.is_path = true, edit.path.resize(1024);
  const auto events = accepted(std::vector<protocol::Action>(300, edit));  // some five pages
  const auto restored = restore(*journal_of(events), {}, Trust::strict);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->seq, 300u);
}

std::vector<history::Event> with_layers() {
  protocol::Edit roof = disc(4, 4, 3);
  roof.layer = 1;
  return accepted(
      {disc(4, 4, 3), protocol::LayerChange{.layer = {}, .name = "roof", .color = {}, .wall = {}},
       roof, protocol::LayerChange{.layer = 1, .name = "spire", .color = {}, .wall = {}}});
}

TEST(Restore, HasTheLayersOfTheSeqFromAKeyframeAndFromTheLog) {
  for (const auto& keyframes : std::vector<std::vector<std::uint64_t>>{{}, {2}, {1, 3}, {4}}) {
    const auto journal = journal_of(with_layers(), keyframes);
    const auto layers = [&journal](std::uint64_t seq) {
      return restore(*journal, seq, Trust::strict)->settings.layers;
    };
    EXPECT_EQ(layers(1).size(), 1u);
    ASSERT_EQ(layers(3).size(), 2u);
    EXPECT_EQ(layers(3)[1].name, "roof");
    EXPECT_EQ(layers(4)[1].name, "spire");
    EXPECT_EQ(journal->identity().settings, small_identity().settings);
  }
}

TEST(Restore, RefusesAKeyframeOfSettingsThatTheMapCannotHave) {
  const auto refusal = [](const std::function<void(protocol::MapSettings&)>& change) {
    auto journal = journal_of(ten_events());
    Keyframe keyframe{.seq = 4, .map_hash = 0, .settings = small_identity().settings};
    change(keyframe.settings);
    EXPECT_TRUE(journal->put_keyframe(keyframe));
    return restore(*journal, {}, Trust::strict).error().detail;
  };
  const std::string cannot = "keyframes: seq 4: settings that the map cannot have";
  EXPECT_EQ(refusal([](auto& settings) { settings.voxel_size = 2; }), cannot);
  EXPECT_EQ(refusal([](auto& settings) { settings.layers.clear(); }), cannot);
  EXPECT_NE(refusal([](auto& settings) { settings.layers.resize(3); }), cannot);
}

TEST(Restore, RefusesAHashThatDiffers) {
  TamperedJournal journal(journal_of(ten_events(), {4}));
  journal.change_event = [](history::Event& event) {
    if (event.seq == 7) event.hash = 0xab;
  };
  for (const Trust trust : {Trust::strict, Trust::salvage}) {
    const auto restored = restore(journal, {}, trust);
    ASSERT_FALSE(restored);
    EXPECT_EQ(restored.error().code, Code::damaged);
    EXPECT_EQ(restored.error().detail,
              "events: seq 7: the stored hash is 00000000000000ab, executed it is " +
                  protocol::hex(ten_events()[6].hash));
  }
  EXPECT_EQ(restore(journal, 6, Trust::strict)->hash, ten_events()[5].hash);
}

TEST(Restore, RefusesWhatNoRoomAccepts) {
  const auto refusal = [](const std::function<void(history::Event&)>& change) {
    TamperedJournal journal(journal_of(ten_events()));
    journal.change_event = change;
    return restore(journal, {}, Trust::strict).error().detail;
  };
  EXPECT_EQ(refusal([](history::Event& event) {
              std::get<protocol::Edit>(event.action).layer = event.seq == 2 ? 1 : 0;
            }),
            "events: seq 2: layer: 1 is outside 0 .. 0");
  EXPECT_EQ(refusal([](history::Event& event) {
              if (event.seq == 2)
                event.action =
                    protocol::LayerChange{.layer = 1, .name = "a", .color = {}, .wall = {}};
            }),
            "events: seq 2: layer: 1 of a map with 1 layers");
  EXPECT_EQ(refusal([](history::Event& event) { event.id = event.seq == 4 ? 101 : event.id; }),
            "events: seq 4: id 101 is not above the last of author 00000000000000a1");
  EXPECT_EQ(refusal([](history::Event& event) { event.id = event.seq == 1 ? 0 : event.id; }),
            "events: seq 1: id 0 is not above the last of author 00000000000000a1");
  EXPECT_EQ(refusal([](history::Event& event) { event.seq += event.seq == 3; }),
            "events: seq 3: is missing");
}

// Limits may change and what was accepted stays; but what a file of anybody asks for is bounded.
TEST(Restore, RefusesEditsBeyondAllLimits) {
  const auto refusal = [](double radius, double x, double y) {
    TamperedJournal journal(journal_of(ten_events()));
    journal.change_event = [=](history::Event& event) {
      if (event.seq == 2) event.action = disc(x, y, radius);
    };
    return restore(journal, {}, Trust::strict).error().detail;
  };
  const std::string beyond = "events: seq 2: an edit beyond all limits";
  EXPECT_EQ(refusal(1e300, 0, 0), beyond);
  EXPECT_EQ(refusal(8193, 0, 0), beyond);
  EXPECT_EQ(refusal(1, -1e300, 0), beyond);
  EXPECT_EQ(refusal(1, 0, 16777217), beyond);
  EXPECT_NE(refusal(513, 1000001, 0), beyond);
}

TEST(Restore, ReadsUpToTheEventBeforeADamagedOne) {
  const auto events = ten_events();
  TamperedJournal journal(journal_of(events));
  journal.unreadable_event = 8;
  EXPECT_EQ(restore(journal, 7, Trust::strict)->hash, events[6].hash);
  EXPECT_EQ(restore(journal, 8, Trust::strict).error().detail, "a.earthwork: events: seq 8: sum");
}

TEST(Restore, NeedsNothingOfTheLogBeforeItsKeyframe) {
  TamperedJournal journal(journal_of(ten_events(), {4, 8}));
  journal.unreadable_event = 8;
  const auto restored = restore(journal, {}, Trust::strict);
  ASSERT_TRUE(restored);
  EXPECT_EQ(restored->hash, ten_events().back().hash);
}

TEST(Restore, SalvagesFromAnEarlierKeyframeAndSaysSo) {
  TamperedJournal journal(journal_of(ten_events(), {4, 8}));
  journal.unreadable_keyframe = 8;
  const auto strict = restore(journal, {}, Trust::strict);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().detail, "a.earthwork: chunks: seq 8: sum");

  const auto salvaged = restore(journal, {}, Trust::salvage);
  ASSERT_TRUE(salvaged);
  EXPECT_EQ(salvaged->hash, ten_events().back().hash);
  EXPECT_EQ(salvaged->keyframe_seq, 4u);
  ASSERT_EQ(salvaged->passed_over.size(), 1u);
  EXPECT_EQ(salvaged->passed_over[0].detail, "a.earthwork: chunks: seq 8: sum");
  EXPECT_EQ(salvaged->authors, restore(*journal_of(ten_events()), {}, Trust::strict)->authors);
}

/// Strict fails with this, and salvage starts from an empty map and gives the right one.
void expect_salvaged_from_the_start(TamperedJournal& journal, const std::string& detail) {
  const auto strict = restore(journal, {}, Trust::strict);
  ASSERT_FALSE(strict);
  EXPECT_EQ(strict.error().code, Code::damaged);
  EXPECT_EQ(strict.error().detail, detail);
  const auto salvaged = restore(journal, {}, Trust::salvage);
  ASSERT_TRUE(salvaged) << salvaged.error().detail;
  EXPECT_EQ(salvaged->hash, ten_events()[salvaged->seq - 1].hash);
  EXPECT_EQ(salvaged->keyframe_seq, 0u);
  ASSERT_FALSE(salvaged->passed_over.empty());
  EXPECT_EQ(salvaged->passed_over.front().detail, detail);
}

TEST(Restore, ComparesTheKeyframesHash) {
  TamperedJournal journal(journal_of(ten_events(), {4}));
  journal.change_keyframes = [](std::vector<Keyframe>& all) { all[0].map_hash = 0xab; };
  expect_salvaged_from_the_start(journal,
                                 "keyframes: seq 4: the stored hash is 00000000000000ab, its "
                                 "chunks give " +
                                     protocol::hex(ten_events()[3].hash));
}

// The log goes no further, so no later event tells.
TEST(Restore, ComparesTheLastKeyframeWithTheLog) {
  TamperedJournal journal(journal_of(ten_events(), {10}));
  const std::uint64_t other = ten_events()[9].hash ^ 1;
  journal.change_event = [other](history::Event& event) {
    if (event.seq == 10) event.hash = other;
  };
  const auto refused = restore(journal, {}, Trust::strict);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "keyframes: seq 10: its chunks give hash " +
                                        protocol::hex(ten_events()[9].hash) +
                                        ", and the log says " + protocol::hex(other));
  EXPECT_EQ(restore(journal, 9, Trust::salvage)->hash, ten_events()[8].hash);
}

TEST(Restore, RefusesChunksThatTheMapCannotHave) {
  for (const auto& change : std::vector<std::function<void(ChunkState&)>>{
           [](ChunkState& state) { state.key.layer = 1; },
           [](ChunkState& state) { state.key.z = 1; },
           [](ChunkState& state) { state.key.x = 125'072; },
           [](ChunkState& state) { state.chunk = voxel::Chunk(16); }}) {
    TamperedJournal journal(journal_of(ten_events(), {1}));
    journal.change_chunk = change;
    expect_salvaged_from_the_start(journal, "chunks: seq 1: a chunk that the map cannot have");
  }
}

TEST(Restore, RefusesChunksFromAfterTheirKeyframe) {
  TamperedJournal journal(journal_of(ten_events(), {1}));
  journal.change_chunk = [](ChunkState& state) { state.seq = 2; };
  expect_salvaged_from_the_start(journal, "chunks: seq 2: a chunk that the map cannot have");
}

TEST(Restore, RefusesAuthorsWhoseIdsDoNotIncrease) {
  TamperedJournal journal(journal_of(ten_events(), {8}));
  journal.change_authors = [](std::vector<AuthorState>& all) {
    std::ranges::reverse(all[1].applied);
  };
  expect_salvaged_from_the_start(
      journal, "authors: seq 7: what follows it of author 00000000000000a1 is not above");
}

TEST(Restore, NoticesThatTheEndOfTheLogIsMissing) {
  TamperedJournal journal(journal_of(ten_events(), {8}));
  journal.last = 6;
  expect_salvaged_from_the_start(journal, "keyframes: seq 8: the log has only 6 events");
}

TEST(Restore, SalvagesWithoutAnyKeyframe) {
  TamperedJournal journal(journal_of(ten_events(), {8}));
  journal.keyframes_failure = {Code::damaged, "a.earthwork: keyframes", {}};
  expect_salvaged_from_the_start(journal, "a.earthwork: keyframes");
}

TEST(Restore, DoesNotPassOverADiskThatFails) {
  TamperedJournal journal(journal_of(ten_events(), {8}));
  journal.authors_failure = {Code::storage_failed, "a.earthwork: I/O", {}};
  EXPECT_EQ(restore(journal, {}, Trust::salvage).error().code, Code::storage_failed);
}

TEST(Restore, TakesAuthorsWhoWerePutBeyondTheKeyframe) {
  TamperedJournal journal(journal_of(ten_events(), {4}));
  const auto all = restore(journal, {}, Trust::strict)->authors;
  journal.change_authors = [&all](std::vector<AuthorState>& put) { put = all; };
  EXPECT_EQ(restore(journal, {}, Trust::strict)->authors, all);
  EXPECT_EQ(restore(journal, 5, Trust::strict)->authors,
            restore(*journal_of(ten_events()), 5, Trust::strict)->authors);
}

}  // namespace
}  // namespace earthwork::journal
