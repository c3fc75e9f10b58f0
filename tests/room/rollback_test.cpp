// Taking back: whatever was applied, meshed and asked for meanwhile, after a failed commit
// everything is as it was, and everybody ends with the map as it is stored.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdint>
#include <map>
#include <vector>

#include "server/history/fold.hpp"
#include "tests/room/slow_world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;

protocol::Edit some_edit() {
  const double x = *rc::gen::inRange(0, 640) / 8.0, y = *rc::gen::inRange(0, 640) / 8.0;
  const double radius =
      *rc::gen::weightedOneOf<int>({{8, rc::gen::inRange(0, 70)}, {1, rc::gen::inRange(70, 400)}}) /
      8.0;
  const bool fill = *rc::gen::weightedElement<bool>({{2, true}, {1, false}});
  if (*rc::gen::inRange(0, 25) != 0)
    return *rc::gen::arbitrary<bool>() ? box(x, y, radius, fill) : disc(x, y, radius, fill);
  protocol::Edit large = disc(x, y, 20, fill);  // 7 x 7 chunks each: prepared in slices
  large.is_path = true;
  for (int i = 1; i < 170; ++i) large.path.push_back({x + i / 16.0, y});
  return large;
}

/// Mostly an edit of the first layer; sometimes of another one, which may not be there.
protocol::Action some_action() {
  const auto layer = *rc::gen::inRange(0u, 4u);
  switch (*rc::gen::weightedElement<int>({{12, 0}, {6, 1}, {2, 2}, {1, 3}})) {
    case 0:
      return some_edit();
    case 1:
      return on_layer(layer, some_edit());
    case 2:
      return add_layer("added");
    default:
      return rename_layer(layer, "named");
  }
}

/// What a viewer was told, and whether it could be.
struct Witness {
  World::Guest guest;
  protocol::View view = view_all(0);
  std::size_t checked = 0;
  std::uint64_t told = 0;
  bool caught_up = true;

  void check(const SlowWorld& world) {
    for (; checked < guest.eyes->parcels.size(); ++checked) {
      const Parcel& parcel = guest.eyes->parcels[checked];
      if (parcel.group) RC_ASSERT(parcel.group->seq >= told);
      if (parcel.group) told = parcel.group->seq;
      if (parcel.caught_up) catch_up(*parcel.caught_up, world);
    }
    const std::uint64_t durable = world.journal->last_seq();
    RC_ASSERT(told <= durable);
    for (const auto& [key, record] : guest.eyes->chunks) RC_ASSERT(record.revision <= durable);
    for (const auto& ack : guest.eyes->acks) RC_ASSERT(ack.seq <= durable);
    if (caught_up && !view.rect) RC_ASSERT(torn_rim(guest.eyes->chunks, 8) == "");
  }
  /// What is outside the view is not kept up to date, and forgotten.
  void catch_up(const protocol::CaughtUp& word, const SlowWorld& world) {
    RC_ASSERT(word.n == view.n);
    RC_ASSERT(word.seq >= told);
    told = word.seq;
    caught_up = true;
    const ViewArea area(view.rect, world.room->settings());
    std::erase_if(guest.eyes->chunks, [&](const auto& chunk) {
      const protocol::ChunkKey& key = chunk.first;
      return !area.contains({key.layer, key.x, key.y, key.z});
    });
  }
  void look(SlowWorld& world, bool all) {
    if (!caught_up) return;
    const std::uint32_t n = view.n + 1;
    const double x = *rc::gen::inRange(0, 60), y = *rc::gen::inRange(0, 60);
    view = all ? view_all(n) : view_rect(n, {x, y, x + 30, y + 30});
    caught_up = false;
    RC_ASSERT(world.room->look(guest.id, view).has_value());
  }
};

/// The log folds to what is durable, and its events are those that were acknowledged.
void check_log(SlowWorld& world) {
  const auto events = world.events();
  voxel::Map again = history::make_map(world.journal->identity().settings);
  RC_ASSERT(history::verify(again, events) == std::nullopt);
  RC_ASSERT(again.hash() == world.room->info().hash);
  RC_ASSERT(events.size() == world.room->info().seq);
  protocol::MapSettings settings = world.journal->identity().settings;
  for (const history::Event& event : events) protocol::apply(event.action, settings);
  RC_ASSERT(settings == world.room->settings());
}

void step(SlowWorld& world, std::vector<Witness>& witnesses) {
  Witness& who = witnesses[*rc::gen::inRange<std::size_t>(0, witnesses.size())];
  switch (*rc::gen::weightedElement<int>(
      {{5, 0}, {5, 1}, {4, 2}, {2, 3}, {4, 4}, {1, 5}, {1, 6}, {2, 7}, {1, 8}})) {
    case 0:
      (void)world.submit(who.guest, some_action());  // refused for a second after a failure
      break;
    case 1:
      world.context.run(*rc::gen::inRange(1, 8));
      break;
    case 2:
      world.clerk->run(*rc::gen::inRange(1, 3));
      break;
    case 3:
      world.fickle->trouble = protocol::Failure{Code::disk_full, "the disk is full", {}};
      world.clerk->run();
      world.fickle->trouble.reset();
      break;
    case 4:
      world.room->ready(who.guest.id);
      break;
    case 5:
      who.look(world, *rc::gen::inRange(0, 3) != 0);
      break;
    case 6:
      (void)world.room->refresh_meshes(static_cast<std::size_t>(*rc::gen::inRange(0, 30)));
      break;
    case 8:  // the batch in flight ends well, and what is handed over then fails at once
      world.clerk->run();
      world.fickle->trouble = protocol::Failure{Code::disk_full, "the disk is full", {}};
      world.clerk->at_once = true;
      world.context.run(*rc::gen::inRange(1, 8));
      world.clerk->at_once = false;
      world.fickle->trouble.reset();
      break;
    default:
      world.context.advance(std::chrono::milliseconds(*rc::gen::element(1, 100, 1000)));
  }
}

TEST(Rollback, EverybodyEndsWithWhatIsStored) {
  EXPECT_TRUE(rc::check([] {
    SlowWorld world;
    std::vector<Witness> witnesses;
    for (int i = 0; i < 3; ++i) witnesses.push_back({.guest = world.enter()});
    for (int i = *rc::gen::weightedElement<int>({{3, 0}, {1, 50}}); i > 0; --i)
      (void)world.enter();  // in a crowd it rests
    witnesses[0].look(world, true);

    const int steps = *rc::gen::inRange(1, 120);
    for (int i = 0; i < steps; ++i) {
      step(world, witnesses);
      for (Witness& witness : witnesses) witness.check(world);
    }
    world.commit_all();
    world.wait_out_the_pause();
    check_log(world);
    const std::uint64_t hash = world.mesh_hash();
    for (Witness& witness : witnesses) {
      for (int i = 0; i < 2; ++i) {
        world.settle(witness.guest);
        witness.check(world);
        witness.look(world, true);
      }
      world.settle(witness.guest);
      witness.check(world);
      RC_ASSERT(witness.caught_up);
      RC_ASSERT(witness.guest.eyes->mesh_hash() == hash);
    }
    // And meshes that were never taken back are the same.
    World anew;
    World::Guest painter = anew.enter();
    for (const history::Event& event : world.events()) anew.edit(painter, event.action);
    RC_ASSERT(anew.mesh_hash() == hash);
  }));
}

/// The viewer has looked from the start, never again, and is only told what changes.
TEST(Rollback, DeltasFitWhateverWasTakenBack) {
  EXPECT_TRUE(rc::check([] {
    SlowWorld world;
    World::Guest painter = world.enter(), viewer = world.enter();
    world.look(viewer, view_all(1));
    const int rounds = *rc::gen::inRange(1, 30);
    for (int i = 0; i < rounds; ++i) {
      const int edits = *rc::gen::inRange(1, 4);
      for (int n = 0; n < edits; ++n) {
        const double x = *rc::gen::inRange(0, 200) / 8.0, y = *rc::gen::inRange(0, 200) / 8.0;
        (void)world.submit(painter, disc(x, y, *rc::gen::inRange(0, 30) / 8.0,
                                         *rc::gen::weightedElement<bool>({{3, true}, {1, false}})));
        if (*rc::gen::arbitrary<bool>()) world.context.run();
      }
      world.context.run();
      if (*rc::gen::inRange(0, 3) == 0)
        world.fail();
      else
        world.commit();
      if (*rc::gen::arbitrary<bool>()) world.room->ready(viewer.id);  // throws at a wrong base
      world.wait_out_the_pause();
      RC_ASSERT(torn_rim(viewer.eyes->chunks, 8) == "");
    }
    world.commit_all();
    world.settle(viewer);
    RC_ASSERT(viewer.eyes->mesh_hash() == world.mesh_hash());
    check_log(world);
  }));
}

}  // namespace
}  // namespace earthwork::room
