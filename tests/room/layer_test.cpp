// Layers of a live map: they are added and changed in the order of the edits, stored before they
// are told, told before they are shown, and taken back with what could not be stored.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/history/fold.hpp"
#include "tests/room/slow_world.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Applied;
using protocol::Code;

std::vector<std::string> names(const protocol::MapSettings& settings) {
  std::vector<std::string> names;
  for (const auto& layer : settings.layers) names.push_back(layer.name);
  return names;
}

using Names = std::vector<std::string>;

protocol::MapSettings fifteen_layers() {
  protocol::MapSettings settings = kSmallChunks;
  settings.layers.resize(15);
  return settings;
}

/// Commits are at once.
struct LayerTest : testing::Test, World {
  LayerTest() : ann(enter("ann")), bob(enter("bob")) { look(bob, view_all(1)); }
  Guest ann, bob;
};

TEST_F(LayerTest, IsNumberedAmongTheEditsAndChangesNoHash) {
  edit(ann, disc(4, 4, 2));
  const std::uint64_t hash = room->info().hash;
  edit(bob, add_layer("roof"));
  edit(ann, rename_layer(0, "meadow"));
  EXPECT_EQ(bob.eyes->acks, (std::vector<Applied>{{1, 2}}));
  EXPECT_EQ(ann.eyes->acks, (std::vector<Applied>{{1, 1}, {2, 3}}));
  EXPECT_EQ(room->info().seq, 3u);
  EXPECT_EQ(room->info().hash, hash);
  EXPECT_EQ(names(room->settings()), (Names{"meadow", "roof"}));
  EXPECT_EQ(room->info().settings, room->settings());
  const auto kept = events();
  EXPECT_EQ(kept[1].action, protocol::Action(add_layer("roof")));
  EXPECT_EQ(kept[1].hash, hash);
}

TEST_F(LayerTest, IsToldToAllWhoAreInside) {
  edit(ann, add_layer("roof"));
  for (const Guest& guest : {ann, bob}) {
    ASSERT_EQ(guest.eyes->settings_told.size(), 1u);
    EXPECT_EQ(guest.eyes->settings_told[0].seq, 1u);
    EXPECT_EQ(guest.eyes->settings_told[0].settings, room->settings());
  }
  room->leave(bob.id);
  edit(ann, rename_layer(1, "spire"));
  EXPECT_EQ(bob.eyes->settings_told.size(), 1u);
  EXPECT_EQ(ann.eyes->settings_told.size(), 2u);
  edit(ann, disc(4, 4, 2));
  EXPECT_EQ(ann.eyes->settings_told.size(), 2u);
}

TEST_F(LayerTest, IsInWhatAJoinTells) {
  edit(ann, add_layer("roof"));
  const auto late = std::make_shared<Onlooker>();
  const auto joined = room->join(late, {"00000000000000bb", "late", {}, {}}).value().joined;
  EXPECT_EQ(joined.seq, 1u);
  EXPECT_EQ(names(joined.settings), (Names{"ground", "roof"}));
  EXPECT_TRUE(late->settings_told.empty());
}

TEST_F(LayerTest, IsAnEventForWhoFollows) {
  ASSERT_TRUE(room->follow(bob.id, 1));
  edit(ann, add_layer("roof"));
  context.advance(1s);
  room->heard(bob.id);
  context.run();
  const auto told = bob.eyes->events();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].action, protocol::Action(add_layer("roof")));
  EXPECT_EQ(told[0].author, protocol::hex(ann.author));
}

TEST_F(LayerTest, ThatWasAddedIsSeenInViewsThatThereAre) {
  Guest carl = enter("carl");
  look(carl, view_rect(1, {0, 0, 20, 20}));
  edit(ann, add_layer("roof"));
  edit(ann, on_layer(1, disc(8, 8, 3)));
  settle(bob), settle(carl);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
  EXPECT_EQ(carl.eyes->mesh_hash(), mesh_hash());
  EXPECT_EQ(bob.eyes->chunks.begin()->first.layer, 1);
  // And in one that comes later, of fewer chunks than the map has.
  for (int x = 0; x < 9; ++x) edit(ann, on_layer(1, disc(40.0 + 8 * x, 4, 3)));
  Guest dora = enter("dora");
  look(dora, view_rect(1, {8, 8, 9, 9}));
  EXPECT_FALSE(dora.eyes->chunks.empty());
}

TEST_F(LayerTest, MayBePaintedOnBeforeAnybodyWasToldOfIt) {
  ASSERT_TRUE(submit(ann, add_layer("roof")));
  ASSERT_TRUE(submit(ann, on_layer(1, disc(4, 4, 2))));
  ASSERT_TRUE(submit(ann, on_layer(2, disc(4, 4, 2))));
  ASSERT_TRUE(submit(ann, add_layer("spire")));
  context.run();
  EXPECT_EQ(ann.eyes->acks, (std::vector<Applied>{{1, 1}, {2, 2}, {4, 3}}));
  ASSERT_EQ(ann.eyes->refusals.size(), 1u);
  EXPECT_EQ(ann.eyes->refusals[0].id, 3);
  EXPECT_EQ(ann.eyes->refusals[0].failure.code, Code::out_of_range);
  EXPECT_EQ(ann.eyes->refusals[0].failure.field, "layer");
  EXPECT_EQ(ann.eyes->refusals[0].failure.detail, "layer: 2 is outside 0 .. 1");
}

TEST_F(LayerTest, ThatIsNotThereRefusesALargeEditTooBeforeItIsPrepared) {
  protocol::Edit large = on_layer(1, disc(0, 0, 20));
  large.is_path = true;
  for (int i = 1; i < 1000; ++i) large.path.push_back({i / 16.0, 0});
  ASSERT_TRUE(submit(ann, large));
  context.run();
  ASSERT_EQ(ann.eyes->refusals.size(), 1u);
  EXPECT_EQ(ann.eyes->refusals[0].failure.field, "layer");
  ann.last_message = 0;
  ASSERT_TRUE(submit(bob, add_layer("roof")));
  context.run();
  ASSERT_TRUE(submit(ann, large));  // a refused id may be used again
  context.run();
  EXPECT_EQ(ann.eyes->acks, (std::vector<Applied>{{1, 2}}));
}

TEST_F(LayerTest, SentAgainIsAnsweredAgain) {
  edit(ann, add_layer("roof"));
  ann.last_message = 0;
  edit(ann, add_layer("roof"));
  EXPECT_EQ(ann.eyes->acks, (std::vector<Applied>{{1, 1}, {1, 1}}));
  EXPECT_EQ(names(room->settings()), (Names{"ground", "roof"}));
  EXPECT_EQ(ann.eyes->settings_told.size(), 1u);
}

TEST_F(LayerTest, IsInAnExportAndInThePictureOfStates) {
  EXPECT_FALSE(room->states(1));
  edit(ann, add_layer("roof"));
  edit(ann, on_layer(1, box(4, 4, 2)));
  static_cast<void>(mesh_hash());
  EXPECT_EQ(room->meshes().settings, room->settings());
  EXPECT_TRUE(room->states(1));
}

TEST(Layers, OfTwoWhoAddTheSixteenthOneIsRefused) {
  World world(fifteen_layers());
  World::Guest ann = world.enter("ann"), bob = world.enter("bob");
  ASSERT_TRUE(world.submit(ann, add_layer("a")));
  ASSERT_TRUE(world.submit(bob, add_layer("b")));
  world.context.run();
  EXPECT_EQ(world.room->info().seq, 1u);
  EXPECT_EQ(world.room->settings().layers.size(), 16u);
  ASSERT_EQ(ann.eyes->refusals.size() + bob.eyes->refusals.size(), 1u);
  const Onlooker& refused = ann.eyes->refusals.empty() ? *bob.eyes : *ann.eyes;
  EXPECT_EQ(refused.refusals[0].failure.code, Code::too_large);
  EXPECT_TRUE(refused.acks.empty());
}

/// Commits end when the test says so.
struct SlowLayerTest : testing::Test, SlowWorld {
  SlowLayerTest() : ann(enter("ann")), bob(enter("bob")) { look(bob, view_all(1)); }
  Guest ann, bob;
};

TEST_F(SlowLayerTest, IsToldToNobodyBeforeItIsStored) {
  edit(ann, add_layer("roof"));
  edit(ann, on_layer(1, disc(4, 4, 2)));
  context.advance(1s);
  EXPECT_TRUE(ann.eyes->settings_told.empty());
  EXPECT_TRUE(ann.eyes->acks.empty());
  EXPECT_EQ(names(room->settings()), Names{"ground"});
  EXPECT_EQ(names(room->info().settings), Names{"ground"});
  commit();
  EXPECT_EQ(ann.eyes->settings_told.size(), 1u);
  EXPECT_EQ(names(room->settings()), (Names{"ground", "roof"}));
  commit_all();
  settle(bob);  // which expects no chunk of a layer that was not told
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
}

TEST_F(SlowLayerTest, IsPointedAtOnceItIsStored) {
  const protocol::Cursor cursor{.at = protocol::MapPoint{1, 2},
                                .brush = protocol::Brush{.radius = 1, .layer = 1},
                                .view = {},
                                .id = {}};
  edit(ann, add_layer("roof"));
  EXPECT_EQ(room->point(ann.id, cursor).error().field, "layer");
  commit();
  EXPECT_TRUE(room->point(ann.id, cursor));
}

TEST_F(SlowLayerTest, OfABatchAllThatChangedIsToldAtOnce) {
  edit(bob, disc(4, 4, 1));
  for (const char* name : {"a", "b", "c"}) edit(ann, add_layer(name));
  edit(ann, disc(5, 4, 1));
  commit_all();
  ASSERT_EQ(bob.eyes->settings_told.size(), 1u);
  EXPECT_EQ(bob.eyes->settings_told[0].seq, 4u);
  EXPECT_EQ(names(bob.eyes->settings_told[0].settings), (Names{"ground", "a", "b", "c"}));
}

TEST_F(SlowLayerTest, ThatCouldNotBeStoredWasNeverThere) {
  edit(ann, rename_layer(0, "meadow"));
  commit_all();
  edit(ann, add_layer("roof"));
  edit(ann, on_layer(1, disc(4, 4, 2)));
  edit(bob, rename_layer(0, "desert"));
  fail();
  EXPECT_EQ(names(room->settings()), Names{"meadow"});
  EXPECT_EQ(ann.eyes->settings_told.size(), 1u);
  EXPECT_EQ(ann.eyes->refusals.size(), 2u);
  EXPECT_EQ(bob.eyes->refusals.size(), 1u);
  EXPECT_FALSE(room->states(1));
  EXPECT_EQ(room->info().hash, 0u);

  wait_out_the_pause();
  edit(bob, on_layer(1, disc(4, 4, 2)));  // there is no such layer
  edit(ann, add_layer("spire"));
  edit(ann, on_layer(1, disc(4, 4, 2)));
  commit_all();
  EXPECT_EQ(bob.eyes->refusals.back().failure.code, Code::out_of_range);
  EXPECT_EQ(names(room->settings()), (Names{"meadow", "spire"}));
  settle(bob);
  EXPECT_EQ(bob.eyes->mesh_hash(), mesh_hash());
  EXPECT_NE(mesh_hash(), 0u);
}

// The second's refusal rests on a layer that is taken back: it is told what went wrong.
TEST(Layers, ARefusalThatRestsOnWhatIsTakenBackIsOfTheJournal) {
  SlowWorld world(fifteen_layers());
  World::Guest ann = world.enter("ann"), bob = world.enter("bob");
  world.edit(ann, add_layer("a"));
  world.edit(bob, add_layer("b"));
  world.fail();
  ASSERT_EQ(bob.eyes->refusals.size(), 1u);
  EXPECT_EQ(bob.eyes->refusals[0].failure.code, Code::disk_full);
  world.wait_out_the_pause();
  world.edit(bob, add_layer("b"));
  world.commit_all();
  EXPECT_EQ(bob.eyes->acks.size(), 1u);
  EXPECT_EQ(world.room->settings().layers.back().name, "b");
}

}  // namespace
}  // namespace earthwork::room
