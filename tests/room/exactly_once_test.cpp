// Exactly once: whatever is sent again, from wherever, an edit of an author is applied once and
// always answered alike.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "server/history/fold.hpp"
#include "tests/room/world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;
using protocol::MessageId;

struct ExactlyOnceTest : testing::Test, World {
  void send(const Guest& guest, MessageId id, const protocol::Edit& edit) {
    ASSERT_TRUE(room->submit(guest.id, {id, guest.author, edit}));
  }
};

TEST_F(ExactlyOnceTest, ARepeatedEditIsAnsweredAgainAndNotApplied) {
  Guest a = enter();
  send(a, 5, disc(4, 4, 2));
  send(a, 6, disc(9, 4, 2));
  context.run();
  send(a, 5, disc(30, 30, 7));  // whatever it says beside its id
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{5, 1}, {6, 2}, {5, 1}}));
  EXPECT_EQ(room->info().seq, 2u);
  EXPECT_EQ(meters->edits, 2u);
  EXPECT_EQ(meters->repeated, 1u);
}

TEST_F(ExactlyOnceTest, SoIsOneThatIsStillInLine) {
  Guest a = enter();
  send(a, 5, disc(4, 4, 2));
  send(a, 5, disc(4, 4, 2));
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{5, 1}, {5, 1}}));
  EXPECT_EQ(room->info().seq, 1u);
}

TEST_F(ExactlyOnceTest, AnAuthorIsTheSameInEverySession) {
  Guest before = enter("ann", 77);
  send(before, 1, disc(4, 4, 2)), send(before, 2, disc(9, 4, 2));
  room->leave(before.id);
  Guest after = enter("ann", 77);
  send(after, 1, disc(4, 4, 2)), send(after, 2, disc(9, 4, 2)), send(after, 3, disc(4, 9, 2));
  context.run();
  EXPECT_TRUE(before.eyes->acks.empty());
  EXPECT_EQ(after.eyes->acks, (std::vector<protocol::Applied>{{1, 1}, {2, 2}, {3, 3}}));
}

TEST_F(ExactlyOnceTest, AuthorsHaveIdsOfTheirOwn) {
  Guest a = enter(), b = enter();
  send(a, 1, disc(4, 4, 2)), send(b, 1, disc(9, 4, 2));
  context.run();
  EXPECT_EQ(a.eyes->acks.at(0).seq + b.eyes->acks.at(0).seq, 3u);
}

TEST_F(ExactlyOnceTest, AnIdBelowAnAppliedOneIsRefused) {
  Guest a = enter();
  send(a, 5, disc(4, 4, 2)), send(a, 4, disc(9, 4, 2)), send(a, 6, disc(4, 9, 2));
  context.run();
  ASSERT_EQ(a.eyes->refusals.size(), 1u);
  EXPECT_EQ(a.eyes->refusals[0].id, 4);
  EXPECT_EQ(a.eyes->refusals[0].failure.code, Code::id_out_of_order);
  EXPECT_EQ(a.eyes->refusals[0].failure.field, "id");
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{5, 1}, {6, 2}}));
}

TEST_F(ExactlyOnceTest, TheLast4096AreRememberedAndNotOneMore) {
  Guest a = enter();
  for (MessageId id = 1; id <= 4097; ++id) send(a, id, disc(4, 4, 0));
  context.run();
  send(a, 2, disc(4, 4, 0)), send(a, 1, disc(4, 4, 0));
  context.run();
  EXPECT_EQ(a.eyes->acks.back(), (protocol::Applied{2, 2}));
  ASSERT_EQ(a.eyes->refusals.size(), 1u);
  EXPECT_EQ(a.eyes->refusals[0].id, 1);
  EXPECT_EQ(a.eyes->refusals[0].failure.code, Code::id_too_old);
  EXPECT_NE(a.eyes->refusals[0].failure.detail.find("4096"), std::string::npos);
  EXPECT_EQ(room->info().seq, 4097u);
}

TEST_F(ExactlyOnceTest, ARefusedEditLeavesNoTrace) {
  Guest a = enter();
  EXPECT_FALSE(room->submit(a.id, {1, a.author, disc(4, 4, 513)}));
  send(a, 1, disc(4, 4, 2));
  context.run();
  EXPECT_EQ(a.eyes->acks, (std::vector<protocol::Applied>{{1, 1}}));
}

/// A client that does what protocol/README.md says: keeps each edit until it was answered, and
/// sends what was not answered again after it has lost its connection.
struct Client {
  World& world;
  std::uint64_t author;
  std::optional<World::Guest> guest{};
  std::map<MessageId, protocol::Edit> edits{};
  std::map<MessageId, std::uint64_t> answers{};  // seqs
  std::set<MessageId> skipped{};                 // and never applied
  MessageId last = 0;

  void connect() {
    if (guest) return;
    guest = world.enter("somebody", author);
    for (const auto& [id, edit] : edits)
      if (!answers.contains(id)) send(id);
  }
  /// What is in line is applied; whether it hears of it is up to the room.
  void disconnect(bool politely) {
    if (!guest) return;
    if (politely)
      world.room->leave_when_told(guest->id, [] {});
    else
      world.room->leave(guest->id);
    listen();
    guest.reset();
  }
  void send(MessageId id) {
    const auto edit = edits.find(id);
    const auto& what = edit == edits.end() ? disc(0, 0, 1) : edit->second;
    RC_ASSERT(world.room->submit(guest->id, {id, author, what}));
  }
  void make(const protocol::Edit& edit, MessageId gap) {
    for (; gap > 0; --gap) skipped.insert(++last);
    edits[++last] = edit;
    if (guest) send(last);
  }
  void listen() {
    if (!guest) return;
    for (const auto& [id, seq] : std::exchange(guest->eyes->acks, {})) {
      RC_ASSERT(edits.contains(id));
      RC_ASSERT(answers.try_emplace(id, seq).first->second == seq);
    }
    for (const auto& refusal : std::exchange(guest->eyes->refusals, {})) {
      RC_ASSERT(refusal.failure.code == Code::id_out_of_order);
      RC_ASSERT(skipped.contains(*refusal.id));
    }
  }
};

/// One in ten is too large to be applied at once, one in three is elsewhere.
protocol::Edit some_edit() {
  const double away = *rc::gen::element(0.0, 0.0, 300.0);
  const double x = *rc::gen::inRange(0, 320) / 8.0 + away, y = *rc::gen::inRange(0, 320) / 8.0;
  const double radius = *rc::gen::inRange(0, 70) / 8.0;
  const bool fill = *rc::gen::weightedElement<bool>({{2, true}, {1, false}});
  if (*rc::gen::inRange(0, 10) != 0)
    return *rc::gen::arbitrary<bool>() ? box(x, y, radius, fill) : disc(x, y, radius, fill);
  protocol::Edit large = disc(x, y, 20, fill);  // 7 x 7 chunks each
  large.is_path = true;
  for (int i = 1; i < 170; ++i) large.path.push_back({x + i / 16.0, y});
  return large;
}

void act(Client& client) {
  const int what = *rc::gen::inRange(0, 9);
  if (what == 0) return client.disconnect(*rc::gen::arbitrary<bool>());
  if (what <= 2) return client.connect();
  if (what <= 6) return client.make(some_edit(), *rc::gen::inRange<MessageId>(0, 2));
  if (!client.guest || client.last == 0) return;
  const auto again = *rc::gen::inRange<MessageId>(1, client.last + 1);
  if (what == 7 || client.edits.contains(again)) client.send(again);
}

/// The events are every edit of every client once, and fold to the map, hash by hash.
void check_events(World& world, const std::vector<Client>& clients) {
  const auto events = world.events();
  std::set<std::pair<std::uint64_t, MessageId>> seen;
  for (const history::Event& event : events)
    RC_ASSERT(seen.insert({event.author, event.id}).second);
  std::size_t sent = 0;
  for (const Client& client : clients) {
    sent += client.edits.size();
    RC_ASSERT(client.answers.size() == client.edits.size());
    for (const auto& [id, seq] : client.answers) {
      RC_ASSERT(events[seq - 1].author == client.author && events[seq - 1].id == id);
      RC_ASSERT(events[seq - 1].action == protocol::Action(client.edits.at(id)));
    }
  }
  RC_ASSERT(events.size() == sent);

  voxel::Map again = history::make_map(world.room->settings());
  RC_ASSERT(history::verify(again, events) == std::nullopt);
  RC_ASSERT(again.hash() == world.room->info().hash);
}

/// So do those that a follower was told.
void check_follower(World& world, const Onlooker& follower) {
  voxel::Map map = history::make_map(world.room->settings());
  std::uint64_t seq = 0;
  for (const protocol::Event& event : follower.events()) {
    RC_ASSERT(event.seq == ++seq);
    history::apply(map, event.action);
    RC_ASSERT(protocol::hex(map.hash()) == event.hash);
  }
  RC_ASSERT(seq == world.room->info().seq);
}

TEST(ExactlyOnce, HoldsUnderResendsDisconnectsAndRejoins) {
  EXPECT_TRUE(rc::check([] {
    World world;
    World::Guest watcher = world.enter("watcher");
    world.look(watcher, view_all(1));
    RC_ASSERT(world.room->follow(watcher.id, 1));
    std::vector<Client> clients;
    for (std::uint64_t author = 101; author <= 103; ++author) clients.push_back({world, author});

    const int steps = *rc::gen::inRange(0, 60);
    for (int i = 0; i < steps; ++i) {
      act(clients[*rc::gen::inRange<std::size_t>(0, clients.size())]);
      world.context.run(*rc::gen::inRange(0, 3));  // in the midst of a large one, maybe
      if (*rc::gen::inRange(0, 3) != 0) continue;
      world.context.advance(*rc::gen::element(0ms, 40ms, 200ms));
      for (Client& client : clients) client.listen();
      world.room->heard(watcher.id);
      world.room->ready(watcher.id);
      RC_ASSERT(torn_rim(watcher.eyes->chunks, 8) == "");
    }
    for (Client& client : clients) client.connect();
    world.context.advance(1s);
    for (Client& client : clients) client.listen();
    for (int i = 0; i < 3; ++i) world.room->heard(watcher.id);
    world.settle(watcher);

    check_events(world, clients);
    check_follower(world, *watcher.eyes);
    RC_ASSERT(torn_rim(watcher.eyes->chunks, 8) == "");
    RC_ASSERT(watcher.eyes->mesh_hash() == world.mesh_hash());
  }));
}

}  // namespace
}  // namespace earthwork::room
