// What viewers saw before a start is still true after it: a claim is answered with what is new
// since, and nothing else.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/journal/memory_journal.hpp"
#include "server/journal/restore.hpp"
#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using protocol::ChunkKey;
using protocol::Result;

/// A journal that outlives the clerk that has it, as a file does.
class LentJournal final : public journal::Journal {
 public:
  explicit LentJournal(std::shared_ptr<Journal> lent) : lent_(std::move(lent)) {}
  const journal::Identity& identity() const override { return lent_->identity(); }
  std::uint64_t last_seq() const override { return lent_->last_seq(); }
  Result<void> append(std::uint64_t seq, std::span<const history::Event> events) override {
    return lent_->append(seq, events);
  }
  Result<std::vector<history::Event>> events(std::uint64_t from, std::size_t most) override {
    return lent_->events(from, most);
  }
  Result<void> put_chunks(std::span<const journal::ChunkState> states) override {
    return lent_->put_chunks(states);
  }
  Result<void> put_authors(std::span<const journal::AuthorState> authors) override {
    return lent_->put_authors(authors);
  }
  Result<void> put_keyframe(const journal::Keyframe& keyframe) override {
    return lent_->put_keyframe(keyframe);
  }
  Result<bool> tidy(std::size_t most) override { return lent_->tidy(most); }
  Result<std::vector<journal::Keyframe>> keyframes() override { return lent_->keyframes(); }
  Result<void> chunks(std::uint64_t seq,
                      const std::function<Result<void>(journal::ChunkState)>& take) override {
    return lent_->chunks(seq, take);
  }
  Result<std::vector<journal::AuthorState>> authors() override { return lent_->authors(); }

 private:
  std::shared_ptr<Journal> lent_;
};

using Log = std::shared_ptr<journal::Journal>;

Opening open_again(const Log& log) {
  return {.identity = log->identity(),
          .restored = journal::restore(*log, {}, journal::Trust::strict).value(),
          .clerk = journal::immediate_clerk(std::make_unique<LentJournal>(log)),
          .commits = Commits::later};
}

/// The same map again, as a server that was started anew has it.
struct Session : World {
  explicit Session(const Log& log) : World(open_again(log), *log) {}
};

constexpr protocol::MapRect kAll{-90, -90, 190, 190};

protocol::View claim_of(std::uint64_t seq) {
  protocol::View view = view_rect(1, kAll);
  view.have = protocol::Have{.epoch = protocol::hex(0xABCD), .seq = seq, .rect = kAll};
  return view;
}

/// Takes over what somebody saw before, in a way that a delta to it would be noticed: its base
/// would have another revision.
void remember(const World::Guest& before, World::Guest& again) {
  again.eyes->chunks = before.eyes->chunks;
  for (auto& [key, record] : again.eyes->chunks) record.revision = 0;
}

struct Sent {
  std::vector<ChunkKey> full, removed;
};
Sent sent(const World::Guest& guest) {
  Sent sent;
  for (const Parcel& parcel : guest.eyes->parcels)
    for (const RecordBytes& bytes : parcel.first_seen)
      (decoded(bytes).removed ? sent.removed : sent.full).push_back(decoded(bytes).key);
  for (auto* keys : {&sent.full, &sent.removed}) std::sort(keys->begin(), keys->end());
  return sent;
}

/// A disc in the middle of each of 6 x 6 chunks of 8 voxels, which somebody has seen.
struct RestartTest : testing::Test {
  RestartTest() : painter(first->enter("painter")), seen(first->enter("seen")) {
    for (int x = 0; x < 6; ++x)
      for (int y = 0; y < 6; ++y) first->edit(painter, dot(x, y));
    first->look(seen, view_rect(1, kAll));
    seq = first->room->info().seq;
  }
  static protocol::Edit dot(int x, int y, bool fill = true) {
    return disc(8 * x + 4.5, 8 * y + 4.5, 2, fill);
  }
  /// Everybody has gone, and the map is put away, or its process ends.
  enum class End { put_away, killed };
  void restart(End end) {
    if (end == End::put_away) {
      first->room->leave(painter.id), first->room->leave(seen.id);
      bool closed = false;
      ASSERT_TRUE(first->room->retire([&] { closed = true; }));
      first->context.run();
      ASSERT_TRUE(closed);
      ASSERT_FALSE(log->keyframes()->empty());
    }
    first.reset();
    second = std::make_unique<Session>(log);
  }
  World::Guest back_again(std::uint64_t since) {
    World::Guest guest = second->enter("again");
    remember(seen, guest);
    second->look(guest, claim_of(since));
    return guest;
  }

  /// Of the 36 chunks come the one that is different, the one that is gone, and those whose cells
  /// reach into either: how old their meshes are is known no better.
  void miss_something(End end) {
    first->edit(painter, dot(2, 2, false));
    first->edit(painter, disc(8 * 4 + 4.5, 8 * 4 + 4.5, 3));
    restart(end);
    const World::Guest again = back_again(seq);
    EXPECT_EQ(sent(again).full,
              (std::vector<ChunkKey>{
                  {0, 1, 1}, {0, 1, 2}, {0, 2, 1}, {0, 3, 3}, {0, 3, 4}, {0, 4, 3}, {0, 4, 4}}));
    EXPECT_EQ(sent(again).removed, (std::vector<ChunkKey>{{0, 2, 2}}));
    EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());
  }

  /// A claim of before a layer was added is true of the others, and the map is left with its
  /// layers.
  void miss_a_layer(End end);

  Log log = journal::make_memory_journal(identity_of(kSmallChunks));
  std::unique_ptr<Session> first = std::make_unique<Session>(log), second;
  World::Guest painter, seen;
  std::uint64_t seq = 0;
};

TEST_F(RestartTest, WhoHasAllIsSentNothing) {
  restart(End::killed);
  const World::Guest again = back_again(seq);
  EXPECT_EQ(again.eyes->first_seen(), 0u);
  EXPECT_EQ(*again.eyes->parcels.back().caught_up, (protocol::CaughtUp{1, seq}));
  EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());
}

TEST_F(RestartTest, WhoHasAllIsSentNothingAfterAKeyframeToo) {
  restart(End::put_away);
  const World::Guest again = back_again(seq);
  EXPECT_EQ(again.eyes->first_seen(), 0u);
  EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());
}

TEST_F(RestartTest, WhatWasMissedIsSentAndWhatIsGone) { miss_something(End::killed); }

TEST_F(RestartTest, WhatWasMissedIsSentAfterAKeyframeToo) { miss_something(End::put_away); }

TEST_F(RestartTest, WhoClaimsNothingHearsOfNoRemovals) {
  first->edit(painter, dot(2, 2, false));
  restart(End::killed);
  World::Guest newcomer = second->enter();
  second->look(newcomer, view_rect(1, kAll));
  EXPECT_EQ(sent(newcomer).full.size(), 35u);
  EXPECT_TRUE(sent(newcomer).removed.empty());
}

TEST_F(RestartTest, WhatIsRemovedBeforeAnybodyLooksIsTold) {
  restart(End::killed);
  World::Guest other = second->enter("other", 99);
  second->edit(other, dot(4, 1, false));
  const World::Guest again = back_again(seq);
  EXPECT_EQ(sent(again).removed, (std::vector<ChunkKey>{{0, 4, 1}}));
  EXPECT_TRUE(sent(again).full.empty());  // the edit told which cells it touched
  EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());
}

TEST_F(RestartTest, NoDeltaStartsFromWhatWasSentBefore) {
  restart(End::killed);
  World::Guest again = back_again(seq);
  World::Guest other = second->enter("other");
  second->edit(other, disc(8 * 2 + 5.5, 8 * 2 + 4.5, 2));
  const auto& first_change = again.eyes->parcels.back().group_records;
  ASSERT_EQ(first_change.size(), 1u);
  EXPECT_FALSE(is_delta(first_change[0]));
  second->room->ready(again.id);
  second->edit(other, disc(8 * 2 + 4.5, 8 * 2 + 5.5, 2));
  EXPECT_TRUE(is_delta(again.eyes->parcels.back().group_records.at(0)));
  EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());
}

void RestartTest::miss_a_layer(End end) {
  first->edit(painter, add_layer("roof"));
  first->edit(painter, on_layer(1, dot(2, 2)));
  first->edit(painter, rename_layer(0, "meadow"));
  const protocol::MapSettings left = first->room->settings();
  restart(end);
  EXPECT_EQ(second->room->settings(), left);
  const World::Guest again = back_again(seq);
  EXPECT_EQ(sent(again).full, (std::vector<ChunkKey>{{1, 2, 2}}));
  EXPECT_EQ(again.eyes->mesh_hash(), second->mesh_hash());

  World::Guest other = second->enter("other", 99);
  second->edit(other, on_layer(1, dot(4, 1)));
  second->edit(other, add_layer("spire"));
  ASSERT_EQ(other.eyes->settings_told.size(), 1u);
  EXPECT_EQ(other.eyes->settings_told[0].seq, seq + 5);
  EXPECT_EQ(second->room->settings().layers.size(), 3u);
  // Sent again by who did not hear of it, it is known, and no layer more.
  World::Guest back = second->enter("painter", painter.author);
  back.last_message = painter.last_message - 3;
  second->edit(back, add_layer("roof"));
  EXPECT_EQ(back.eyes->acks, (std::vector<protocol::Applied>{{painter.last_message - 2, seq + 1}}));
  EXPECT_EQ(second->room->settings().layers.size(), 3u);
}

TEST_F(RestartTest, LayersThatWereMissedAreThereAndWhatIsOnThem) { miss_a_layer(End::killed); }

TEST_F(RestartTest, LayersAreThereAfterAKeyframeToo) { miss_a_layer(End::put_away); }

TEST_F(RestartTest, NothingIsMeshedUntilSomebodyLooks) {
  restart(End::killed);
  second->context.advance(std::chrono::seconds(10));
  EXPECT_EQ(second->meters->meshed_chunks, 0u);
  World::Guest guest = second->enter();
  second->look(guest, view_rect(1, {9, 9, 14, 14}));
  EXPECT_LE(second->meters->meshed_chunks, 4u);
  EXPECT_EQ(guest.eyes->chunks.size(), 1u);
}

/// Over any number of starts: whatever is edited when and seen by whom, in the end the scene of a
/// viewer that comes back every time is the map's.
TEST(Restart, WhatWasSeenIsTrueAfterwards) {
  EXPECT_TRUE(rc::check([] {
    const Log log = journal::make_memory_journal(identity_of(kSmallChunks));
    std::optional<World::Guest> before;
    std::uint64_t told = 0;
    const int starts = *rc::gen::inRange(2, 5);
    for (int start = 0; start < starts; ++start) {
      Session session(log);
      World::Guest painter = session.enter("painter", 1000 + static_cast<std::uint64_t>(start));
      World::Guest again = session.enter("again"), other = session.enter("other");
      const auto edit_some = [&] {
        for (int n = *rc::gen::inRange(0, 6); n > 0; --n) {
          session.edit(painter, disc(*rc::gen::inRange(-20, 20), *rc::gen::inRange(-20, 20),
                                     *rc::gen::inRange(0, 9), *rc::gen::arbitrary<bool>()));
          if (*rc::gen::arbitrary<bool>()) session.settle(other);
          if (*rc::gen::arbitrary<bool>()) session.settle(again);
        }
      };
      if (*rc::gen::arbitrary<bool>()) session.look(other, view_rect(1, kAll));
      edit_some();
      if (before) remember(*before, again);
      session.look(again, before ? claim_of(told) : view_rect(1, kAll));
      edit_some();
      session.settle(again);
      session.context.advance(std::chrono::seconds(1));
      session.settle(again);
      const auto durable = session.room->info().seq;
      for (const Parcel& parcel : again.eyes->parcels) {
        if (parcel.group) told = std::max(told, parcel.group->seq);
        if (parcel.caught_up) told = std::max(told, parcel.caught_up->seq);
      }
      RC_ASSERT(told <= durable);
      session.room->leave(again.id);
      RC_ASSERT(again.eyes->mesh_hash() == session.mesh_hash());
      RC_ASSERT(again.eyes->events().empty());
      edit_some();  // unseen
      before = again;
      session.room->leave(painter.id), session.room->leave(other.id);
      if (*rc::gen::arbitrary<bool>()) {
        RC_ASSERT(session.room->retire([] {}));
        session.context.run();
      }
    }
  }));
}

}  // namespace
}  // namespace earthwork::room
