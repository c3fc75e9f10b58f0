// Keyframes beside a map that goes on: what they hold is the map as of their seq, whatever fails or
// changes meanwhile, and nobody waits for more than one small task.
#include "server/room/keyframer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "server/journal/audit.hpp"
#include "server/room/before_images.hpp"
#include "server/room/manual_context.hpp"
#include "tests/journal/logs.hpp"
#include "tests/room/manual_clerk.hpp"

namespace earthwork::room {
namespace {

constexpr std::uint64_t kKeyframeEvents = KeyframePace{}.events;

using journal::AuthorState;
using journal::ChunkState;
using journal::Keyframe;
using protocol::Result;

/// What has come of a journal, and what is to go wrong.
struct Record {
  std::size_t most_chunks = 0, most_authors = 0;  // in one call
  std::vector<Keyframe> keyframes;
  int puts = 0, tidied = 0;
  std::optional<int> fail_after;  // so many puts
  bool throws = false;            // when a keyframe is put
};

/// A journal whose puts may fail.
class WatchedJournal final : public journal::Journal {
 public:
  WatchedJournal(std::unique_ptr<Journal> inner, Record& record)
      : inner_(std::move(inner)), record_(record) {}
  const journal::Identity& identity() const override { return inner_->identity(); }
  std::uint64_t last_seq() const override { return inner_->last_seq(); }
  Result<void> append(std::uint64_t seq, std::span<const history::Event> events) override {
    return inner_->append(seq, events);
  }
  Result<std::vector<history::Event>> events(std::uint64_t from, std::size_t most) override {
    return inner_->events(from, most);
  }
  Result<void> put_chunks(std::span<const ChunkState> states) override {
    record_.most_chunks = std::max(record_.most_chunks, states.size());
    return fails() ? failure() : inner_->put_chunks(states);
  }
  Result<void> put_authors(std::span<const AuthorState> authors) override {
    record_.most_authors = std::max(record_.most_authors, authors.size());
    return fails() ? failure() : inner_->put_authors(authors);
  }
  Result<void> put_keyframe(const Keyframe& keyframe) override {
    if (fails()) return failure();
    if (record_.throws) throw std::bad_alloc();
    record_.keyframes.push_back(keyframe);
    return inner_->put_keyframe(keyframe);
  }
  Result<bool> tidy(std::size_t most) override {
    ++record_.tidied;
    return inner_->tidy(most);
  }
  Result<std::vector<Keyframe>> keyframes() override { return inner_->keyframes(); }
  Result<void> chunks(std::uint64_t seq,
                      const std::function<Result<void>(ChunkState)>& take) override {
    return inner_->chunks(seq, take);
  }
  Result<std::vector<AuthorState>> authors() override { return inner_->authors(); }

 private:
  bool fails() { return record_.fail_after && record_.puts++ >= *record_.fail_after; }
  static Result<void> failure() { return protocol::fail(protocol::Code::disk_full, "no room"); }

  std::unique_ptr<Journal> inner_;
  Record& record_;
};

/// A room's part of it: a map, its log, and what is remembered of the authors.
struct Workshop {
  explicit Workshop(std::unique_ptr<journal::Journal> journal =
                        journal::make_memory_journal(journal::small_identity()),
                    KeyframePace pace = {})
      : clerk(std::make_unique<WatchedJournal>(std::move(journal), record)),
        start(journal::restore(clerk.journal(), {}, journal::Trust::strict).value()),
        map(start.map),
        settings(start.settings),
        keyframer({map, settings, [this](std::uint64_t author) { return authors[author]; }, clerk,
                   back_at_once, *clock, meters},
                  start, pace) {
    for (const AuthorState& author : start.authors) authors[author.author] = author;
    seq = start.seq;
  }

  void edit(const protocol::Edit& edit, std::uint64_t author = 0xA) {
    before.keep(map, static_cast<int>(edit.layer), history::stencils(edit));
    accept(edit, author);
  }
  void change_layers(const protocol::LayerChange& change) {
    protocol::apply(change, settings);
    accept(change, 0xA);
  }
  void accept(const protocol::Action& action, std::uint64_t author) {
    const voxel::Change& change = history::apply(map, action);
    const history::Event event{.seq = ++seq,
                               .time_ms = 5,
                               .author = author,
                               .id = static_cast<std::int64_t>(seq),
                               .action = action,
                               .hash = map.hash()};
    AuthorState& state = authors[author];
    state.author = author;
    state.applied.push_back({event.id, event.seq});
    if (state.applied.size() > protocol::kMaxRememberedIds)
      state.applied.erase(state.applied.begin());
    gathered.push_back(event);
    keyframer.accepted(event, change.changed);
  }
  /// The append of what has gathered is on its way.
  void hand_over() {
    batch = std::exchange(gathered, {});
    batch_settings = settings;
    before.hand_over();
    keyframer.handed_over();
  }
  void succeed() {
    stored = batch_settings;
    if (!batch.empty()) RC_ASSERT(clerk.journal().append(batch.front().seq - 1, batch).has_value());
    batch.clear();
    before.forget_handed_over();
    keyframer.durable();
  }
  void fail() {
    before.take_back(map);
    settings = stored;
    map.set_layers(static_cast<int>(settings.layers.size()));
    seq = clerk.journal().last_seq();
    for (auto& [author, state] : authors)
      std::erase_if(state.applied, [&](const auto& applied) { return applied.seq > seq; });
    batch.clear(), gathered.clear();
    keyframer.taken_back();
  }
  void commit() { hand_over(), succeed(); }
  void edits(int count) {
    for (int i = 0; i < count; ++i) edit(journal::disc(i % 90, i / 90, 1.5));
  }
  /// What a start would make of the journal is the map, and what is remembered.
  bool restores() {
    const auto again = journal::restore(clerk.journal(), {}, journal::Trust::strict);
    if (!again || again->seq != seq || again->hash != map.hash()) return false;
    if (again->settings != settings) return false;
    std::vector<AuthorState> all;
    for (const auto& [author, state] : authors)
      if (!state.applied.empty()) all.push_back(state);
    return again->authors == all;
  }

  Record record;
  ManualClerk clerk;
  ManualContext context;
  std::unique_ptr<Strand> clock = context.make_strand();
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
  journal::Restored start;
  voxel::Map map;
  protocol::MapSettings settings, batch_settings = settings, stored = settings;
  BeforeImages before;
  std::map<std::uint64_t, AuthorState> authors;
  std::uint64_t seq = 0;
  std::vector<history::Event> gathered, batch;
  Keyframer keyframer;
};

TEST(Keyframer, MakesOneAfterEnoughEvents) {
  Workshop w;
  w.edits(kKeyframeEvents - 1);
  w.commit();
  EXPECT_EQ(w.clerk.waiting(), 0u);
  EXPECT_TRUE(w.keyframer.resting());
  w.edit(journal::disc(0, 0, 3));
  w.commit();
  EXPECT_EQ(w.clerk.waiting_idle(), 1u);
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_EQ(w.record.keyframes[0].seq, kKeyframeEvents);
  EXPECT_EQ(w.record.keyframes[0].map_hash, w.map.hash());
  EXPECT_GE(w.record.tidied, 1);
  EXPECT_TRUE(w.keyframer.resting());
  EXPECT_TRUE(w.restores());
  EXPECT_TRUE(journal::audit(w.clerk.journal())->sound());
}

TEST(Keyframer, MakesOneAfterEnoughChunks) {
  Workshop w;
  w.edit(journal::disc(0, 0, 8 * 37));  // 74 x 74 chunks of 8, but for the corners
  w.commit();
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_EQ(w.record.keyframes[0].seq, 1u);
  EXPECT_EQ(w.record.most_chunks, kChunksPerTask);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, NothingIsPutBeforeItsBatchIsDurable) {
  Workshop w;
  w.edits(kKeyframeEvents);
  w.hand_over();
  EXPECT_FALSE(w.keyframer.resting());
  EXPECT_EQ(w.clerk.waiting(), 0u);
  w.succeed();
  EXPECT_EQ(w.clerk.waiting(), 1u);
}

TEST(Keyframer, ABatchThatFailsTakesItsKeyframeWithIt) {
  Workshop w;
  w.edits(kKeyframeEvents);
  w.hand_over();
  w.fail();
  EXPECT_TRUE(w.keyframer.resting());
  EXPECT_EQ(w.clerk.run(), 0);
  w.edits(kKeyframeEvents);
  w.commit();
  w.clerk.run();
  EXPECT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, IsAsOfItsSeqHoweverTheMapGoesOn) {
  Workshop w;
  w.edits(kKeyframeEvents);
  const std::uint64_t hash = w.map.hash();
  w.hand_over();
  w.edit(journal::disc(40, 20, 30, false));
  w.succeed();
  w.clerk.run(3);
  w.edit(journal::disc(10, 20, 9));
  w.commit();
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_EQ(w.record.keyframes[0].map_hash, hash);
  EXPECT_EQ(journal::restore(w.clerk.journal(), kKeyframeEvents, journal::Trust::strict)->hash,
            hash);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, HasTheSettingsOfItsSeqHoweverLayersGoOn) {
  Workshop w;
  w.change_layers({.layer = {}, .name = "roof", .color = {}, .wall = {}});
  protocol::Edit on_it = journal::disc(10, 20, 9);
  on_it.layer = 1;
  w.edit(on_it);
  w.edits(kKeyframeEvents - 2);
  const protocol::MapSettings then = w.settings;
  w.hand_over();
  w.change_layers({.layer = {}, .name = "spire", .color = {}, .wall = {}});
  w.succeed();
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_EQ(w.record.keyframes[0].settings, then);
  w.commit();
  w.clerk.run();
  EXPECT_EQ(journal::restore(w.clerk.journal(), kKeyframeEvents, journal::Trust::strict)->settings,
            then);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, KnowsNothingOfALayerThatWasTakenBack) {
  Workshop w;
  w.edit(journal::disc(0, 0, 3));
  w.commit();
  w.change_layers({.layer = {}, .name = "roof", .color = {}, .wall = {}});
  protocol::Edit on_it = journal::disc(10, 20, 9);
  on_it.layer = 1;
  w.edit(on_it);
  w.hand_over();
  w.fail();
  w.edits(kKeyframeEvents - 1);
  w.commit();
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, OneTaskIsWithTheClerkAtATime) {
  Workshop w;
  w.edit(journal::disc(0, 0, 300));
  w.commit();
  int tasks = 0;
  for (; w.clerk.waiting() > 0; ++tasks) {
    ASSERT_EQ(w.clerk.waiting_idle(), 1u);
    ASSERT_EQ(w.clerk.waiting(), 1u);
    w.clerk.run(1);
  }
  EXPECT_GT(tasks, 4096 / static_cast<int>(kChunksPerTask));
}

TEST(Keyframer, AnotherOneIsNotBegunMeanwhile) {
  Workshop w;
  w.edits(kKeyframeEvents);
  w.commit();
  w.edits(kKeyframeEvents);
  w.commit();
  w.clerk.run();
  EXPECT_EQ(w.record.keyframes.size(), 1u);
  w.edit(journal::disc(1, 1, 1));  // what has gathered is enough already
  w.commit();
  w.clerk.run();
  ASSERT_EQ(w.record.keyframes.size(), 2u);
  EXPECT_EQ(w.record.keyframes[1].seq, 2 * kKeyframeEvents + 1);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, AFailedOneIsMadeAgainLater) {
  Workshop w;
  w.edit(journal::disc(0, 0, 300));
  w.record.fail_after = 5;
  w.commit();
  w.clerk.run();
  EXPECT_TRUE(w.record.keyframes.empty());
  EXPECT_EQ(w.record.puts, 6);  // the first that failed was the last
  w.record.fail_after.reset();
  w.edits(1000);
  w.commit();
  EXPECT_EQ(w.clerk.run(), 0);  // not at once
  w.edits(kKeyframeEvents);
  w.commit();
  w.clerk.run();
  EXPECT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_TRUE(w.restores());
  EXPECT_TRUE(journal::audit(w.clerk.journal())->sound());
}

TEST(Keyframer, CountsWhatIsPutAndWhatFails) {
  Workshop w;
  const auto failures = [&w](protocol::Code code) {
    return w.meters->journal_failures[static_cast<std::size_t>(code)].load();
  };
  w.edits(kKeyframeEvents), w.commit(), w.clerk.run();
  EXPECT_EQ(w.meters->keyframes, 1u);
  w.record.fail_after = 0;
  w.edits(kKeyframeEvents), w.commit(), w.clerk.run();
  EXPECT_EQ(w.meters->keyframes, 1u);
  EXPECT_EQ(failures(protocol::Code::disk_full), 1u);
  w.record.fail_after.reset();
  w.record.throws = true;  // a clerk's thread does not survive an exception
  w.edits(kKeyframeEvents), w.commit(), w.clerk.run();
  EXPECT_EQ(failures(protocol::Code::internal), 1u);
  w.record.throws = false;
  w.edits(kKeyframeEvents), w.commit(), w.clerk.run();
  EXPECT_EQ(w.meters->keyframes, 2u);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, PutsWhatItRemembersOfAuthorsAFewAtATime) {
  Workshop w;
  for (std::uint64_t i = 0; i < kKeyframeEvents; ++i)
    w.edit(journal::disc(i % 5, 0, 1), 0x100 + i % 50);
  w.commit();
  w.clerk.run();
  EXPECT_EQ(w.record.most_authors, kAuthorsPerTask);
  const auto authors = w.clerk.journal().authors().value();
  ASSERT_EQ(authors.size(), 50u);
  EXPECT_EQ(authors[0].applied.size(), 82u);
}

TEST(Keyframer, GoesOnFromWhereTheMapWasLeft) {
  auto w = std::make_unique<Workshop>();
  w->edits(kKeyframeEvents);
  w->commit();
  w->clerk.run();
  w->edit(journal::disc(300, 300, 5), 0xB);
  w->commit();
  const auto log = w->clerk.journal().events(1, SIZE_MAX).value();
  // A journal with that keyframe and that last event, opened anew.
  auto journal = journal::make_memory_journal(journal::small_identity());
  journal::fill(*journal, log, {kKeyframeEvents});
  Workshop again(std::move(journal));
  EXPECT_EQ(again.start.keyframe_seq, kKeyframeEvents);
  int done = 0;
  again.keyframer.finish([&] { ++done; });
  again.clerk.run();
  EXPECT_EQ(done, 1);
  ASSERT_EQ(again.record.keyframes.size(), 1u);
  EXPECT_EQ(again.record.keyframes[0].seq, kKeyframeEvents + 1);
  EXPECT_EQ(again.record.puts, 0);
  EXPECT_LE(again.record.most_chunks, 9u);  // those of the last event, not all
  EXPECT_EQ(again.record.most_authors, 1u);
  EXPECT_TRUE(again.restores());
}

TEST(Keyframer, FinishesWithALastOne) {
  Workshop w;
  int done = 0;
  w.keyframer.finish([&] { ++done; });
  EXPECT_EQ(done, 1);  // nothing has happened
  w.edits(10);
  w.commit();
  w.keyframer.finish([&] { ++done; });
  EXPECT_EQ(done, 1);
  w.clerk.run();
  EXPECT_EQ(done, 2);
  EXPECT_EQ(w.record.keyframes.size(), 1u);
  EXPECT_TRUE(w.restores());
  w.keyframer.finish([&] { ++done; });
  EXPECT_EQ(done, 3);
  EXPECT_EQ(w.record.keyframes.size(), 1u);
}

TEST(Keyframer, FinishesAfterTheOneInTheMaking) {
  Workshop w;
  w.edits(kKeyframeEvents);
  w.commit();
  w.clerk.run(2);
  w.edits(3);
  w.commit();
  int done = 0;
  w.keyframer.finish([&] { ++done; });
  w.clerk.run();
  EXPECT_EQ(done, 1);
  ASSERT_EQ(w.record.keyframes.size(), 2u);
  EXPECT_EQ(w.record.keyframes[1].seq, kKeyframeEvents + 3);
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, FinishesAlsoWhenTheLastOneFails) {
  Workshop w;
  w.edits(10);
  w.commit();
  w.record.fail_after = 0;
  int done = 0;
  w.keyframer.finish([&] { ++done; });
  w.clerk.run();
  EXPECT_EQ(done, 1);
  EXPECT_TRUE(w.record.keyframes.empty());
  EXPECT_TRUE(w.restores());
}

TEST(Keyframer, AClerkThatWorksAtOnceIsNotCalledFromItsTasks) {
  Record record;
  const auto clerk = journal::immediate_clerk(
      std::make_unique<WatchedJournal>(journal::journal_of(journal::ten_events()), record));
  std::optional<journal::Restored> start;
  clerk->post(journal::Urgency::now, [&](journal::Journal& journal) {
    start = journal::restore(journal, {}, journal::Trust::strict).value();
  });
  ManualContext context;
  const auto clock = context.make_strand();
  Keyframer keyframer({start->map, start->settings,
                       [&](std::uint64_t author) {
                         return *std::find_if(start->authors.begin(), start->authors.end(),
                                              [&](const auto& a) { return a.author == author; });
                       },
                       *clerk, back_at_once, *clock, std::make_shared<Meters>()},
                      *start);
  int done = 0;
  keyframer.finish([&] { ++done; });
  EXPECT_EQ(done, 1);
  EXPECT_EQ(record.keyframes.size(), 1u);
}

TEST(Keyframer, WhatComesForARoomThatIsGoneIsDropped) {
  Record record;
  ManualClerk clerk(
      std::make_unique<WatchedJournal>(journal::journal_of(journal::ten_events()), record));
  const auto start = journal::restore(clerk.journal(), {}, journal::Trust::strict).value();
  ManualContext context;
  const auto clock = context.make_strand();
  bool alive = true;
  const auto place = [&] {
    return Workplace{.aside = {}, .back = [&](const Strand::Task& task) {
                       if (alive) task();
                     }};
  };
  auto keyframer = std::make_unique<Keyframer>(
      Keyframer::Subject{start.map, start.settings,
                         [](std::uint64_t a) {
                           return AuthorState{a, {{1, 1}}};
                         },
                         clerk, place, *clock, std::make_shared<Meters>()},
      start);
  keyframer->finish([] { FAIL(); });
  keyframer.reset();
  alive = false;
  EXPECT_EQ(clerk.run(), 1);
}

/// Whatever is edited, fails and is put at which moment: the newest keyframe and the log give the
/// map, and every keyframe is what the log makes.
TEST(Keyframer, WhatItPutIsTheMap) {
  EXPECT_TRUE(rc::check([] {
    Workshop w(journal::make_memory_journal(journal::small_identity()),
               {.events = *rc::gen::inRange<std::uint64_t>(1, 12),
                .chunks = *rc::gen::inRange<std::size_t>(1, 40)});
    const int steps = *rc::gen::inRange(1, 120);
    bool on_its_way = false;
    int asked = 0, done = 0;
    for (int i = 0; i < steps; ++i) {
      switch (*rc::gen::inRange(0, 9)) {
        case 0:
        case 1:
        case 2:
        case 3:
          w.edit(journal::disc(*rc::gen::inRange(-30, 30), *rc::gen::inRange(-30, 30),
                               *rc::gen::inRange(0, 12), *rc::gen::arbitrary<bool>()),
                 *rc::gen::inRange<std::uint64_t>(1, 4));
          break;
        case 4:
          if (!on_its_way && !w.gathered.empty()) w.hand_over(), on_its_way = true;
          break;
        case 5:
          if (on_its_way) *rc::gen::inRange(0, 3) > 0 ? w.succeed() : w.fail();
          on_its_way = false;
          break;
        case 6:
          w.clerk.run(*rc::gen::inRange(1, 4));
          break;
        case 7:
          w.record.puts = 0;
          w.record.fail_after.reset();
          if (*rc::gen::inRange(0, 3) == 0) w.record.fail_after = *rc::gen::inRange(0, 4);
          break;
        default:
          if (!on_its_way && w.gathered.empty() && asked == done)
            ++asked, w.keyframer.finish([&done] { ++done; });
      }
    }
    if (on_its_way) w.succeed();
    w.commit();
    RC_ASSERT(w.restores());
    w.clerk.run();
    RC_ASSERT(asked == done);
    RC_ASSERT(w.restores());
    w.record.fail_after.reset();
    w.keyframer.finish([] {});
    w.clerk.run();
    RC_ASSERT(w.restores());
    if (w.seq > 0) RC_ASSERT(w.clerk.journal().keyframes()->back().seq == w.seq);
    RC_ASSERT(journal::audit(w.clerk.journal())->sound());
  }));
}

}  // namespace
}  // namespace earthwork::room
