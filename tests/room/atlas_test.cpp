// The atlas: maps by name, opened when they are asked for and put away when nobody uses them.
#include "server/room/atlas.hpp"

#include <gtest/gtest.h>

#include "server/room/manual_context.hpp"
#include "tests/room/atlas_calls.hpp"
#include "tests/room/kept_shelf.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;
using Opened = protocol::Result<std::shared_ptr<Room>>;

std::string names_of(const Atlas& atlas) {
  std::string names;
  for (const auto& map : atlas.list()) names += map.name + " ";
  return names;
}

struct AtlasTest : testing::Test {
  ManualContext context;
  Atlas atlas{{.make_strand = [this] { return context.make_strand(); }}};
};

TEST_F(AtlasTest, MakesAndFindsMaps) {
  const auto made = create_map(atlas, "a-1_b", {.chunk_resolution = 16, .chunks = {}});
  ASSERT_TRUE(made);
  EXPECT_EQ(find_map(atlas, "a-1_b"), *made);
  EXPECT_EQ((*made)->settings().chunk_resolution, 16);
  EXPECT_EQ(find_map(atlas, "a-1"), nullptr);
}

TEST_F(AtlasTest, GivesEveryMapAnEpochOfItsOwn) {
  EXPECT_NE(create_map(atlas, "a").value()->epoch(), create_map(atlas, "b").value()->epoch());
}

TEST_F(AtlasTest, RefusesAKnownNameAndABadOne) {
  ASSERT_TRUE(create_map(atlas, "a"));
  EXPECT_EQ(create_map(atlas, "a").error().code, Code::map_exists);
  EXPECT_EQ(create_map(atlas, "A").error().code, Code::bad_name);
  EXPECT_EQ(create_map(atlas, "").error().code, Code::bad_name);
  EXPECT_TRUE(create_map(atlas, std::string(64, 'x')));
  EXPECT_EQ(create_map(atlas, std::string(65, 'x')).error().code, Code::bad_name);
}

TEST_F(AtlasTest, ListsInOrder) {
  ASSERT_TRUE(create_map(atlas, "b") && create_map(atlas, "a") && create_map(atlas, "c"));
  EXPECT_EQ(names_of(atlas), "a b c ");
  EXPECT_EQ(atlas.list()[1].epoch, find_map(atlas, "b")->epoch());
  ASSERT_EQ(atlas.rooms().size(), 3u);
  EXPECT_EQ(atlas.rooms()[2]->name(), "c");
}

TEST_F(AtlasTest, SaysByeToTheViewersOfAnErasedMap) {
  const auto room = create_map(atlas, "a").value();
  const auto eyes = std::make_shared<Onlooker>();
  ASSERT_TRUE(room->join(eyes, {}));
  std::vector<protocol::Result<void>> erased;
  const auto note = [&](const protocol::Result<void>& result) { erased.push_back(result); };
  atlas.erase("a", note);
  EXPECT_EQ(find_map(atlas, "a"), nullptr);
  EXPECT_EQ(names_of(atlas), "");
  EXPECT_TRUE(erased.empty());
  context.run();
  ASSERT_TRUE(eyes->bye);
  EXPECT_EQ(eyes->bye->failure.code, Code::unknown_map);
  ASSERT_EQ(erased.size(), 1u);
  EXPECT_TRUE(erased[0]);
  atlas.erase("a", note);
  EXPECT_EQ(erased.at(1).error().code, Code::unknown_map);
  EXPECT_TRUE(create_map(atlas, "a"));
}

TEST_F(AtlasTest, HasALimit) {
  for (std::size_t i = 0; i < kMaxMaps; ++i)
    ASSERT_TRUE(create_map(atlas, "m" + std::to_string(i)));
  EXPECT_EQ(create_map(atlas, "one-more").error().code, Code::too_large);
  erase_map(atlas, "m7");
  context.run();
  EXPECT_TRUE(create_map(atlas, "one-more"));
}

TEST_F(AtlasTest, InMemoryNothingIsPutAway) {
  const auto room = create_map(atlas, "a").value();
  context.advance(1h);
  EXPECT_EQ(find_map(atlas, "a"), room);
}

TEST_F(AtlasTest, InMemoryARoomThatClosedItselfIsGone) {
  const auto room = create_map(atlas, "a").value();
  room->close({{Code::internal, "a mistake", "map"}, {}});
  atlas.let_go(*room);
  EXPECT_EQ(find_map(atlas, "a"), nullptr);
  EXPECT_TRUE(create_map(atlas, "a"));
}

/// Maps that outlive their rooms. What takes long waits until `run`.
struct KeptAtlasTest : testing::Test {
  KeptAtlasTest() {
    for (const char* name : {"a", "b", "c"})
      shelf->put(name, {.settings = {},
                        .epoch = 0xA0ull + static_cast<unsigned char>(name[0]),
                        .created_ms = 1});
    start();
  }
  void start() {
    atlas = std::make_unique<Atlas>(
        AtlasOptions{.make_strand = [this] { return context.make_strand(); },
                     .shelf = shelf,
                     .aside = [this](Strand::Task task) { aside.push_back(std::move(task)); },
                     .idle = 60s});
    EXPECT_TRUE(atlas->take_stock());
  }
  void run() {
    do {
      context.run();
      for (const auto& task : std::exchange(aside, {})) task();
    } while (!aside.empty() || context.run() > 0);
  }
  /// In seconds, so that what falls due aside is done in its time.
  void pass(std::chrono::seconds time) {
    for (auto t = 0s; t < time; ++t) context.advance(1s), run();
  }
  /// Asks, and is answered later into what is given back.
  std::shared_ptr<std::vector<Opened>> ask(const std::string& name,
                                           Atlas::Errand errand = Atlas::Errand::visit) {
    auto answers = std::make_shared<std::vector<Opened>>();
    atlas->open(name, errand, [answers](const Opened& room) { answers->push_back(room); });
    return answers;
  }
  Opened open(const std::string& name, Atlas::Errand errand = Atlas::Errand::visit) {
    const auto answers = ask(name, errand);
    run();
    EXPECT_EQ(answers->size(), 1u);
    return answers->at(0);
  }
  Opened create(const std::string& name) {
    std::optional<Opened> made;
    atlas->create(name, {}, [&](const Opened& room) { made = room; });
    run();
    return made.value();
  }
  std::shared_ptr<std::vector<protocol::Result<void>>> erase(const std::string& name) {
    auto answers = std::make_shared<std::vector<protocol::Result<void>>>();
    atlas->erase(name, [answers](const protocol::Result<void>& done) { answers->push_back(done); });
    return answers;
  }
  void paint(Room& room, protocol::MessageId id) {
    const auto viewer = room.join(std::make_shared<Onlooker>(), {}).value().viewer;
    EXPECT_TRUE(room.submit(
        viewer, {.id = id,
                 .author = 7,
                 .action = protocol::Edit{.radius = 3, .path = {{5, 5}}, .stroke = {}}}));
    run();
    room.leave(viewer);
  }
  [[nodiscard]] int opened(const std::string& name) const { return shelf->maps.at(name).opened; }
  [[nodiscard]] int open_now(const std::string& name) const {
    return shelf->maps.at(name).open_now;
  }

  ManualContext context;
  std::vector<Strand::Task> aside;
  std::shared_ptr<KeptShelf> shelf = std::make_shared<KeptShelf>();
  std::unique_ptr<Atlas> atlas;
};

TEST_F(KeptAtlasTest, KnowsTheMapsOfTheShelfAndOpensNone) {
  EXPECT_EQ(names_of(*atlas), "a b c ");
  EXPECT_FALSE(atlas->list()[0].epoch);
  EXPECT_TRUE(atlas->rooms().empty());
  run();
  for (const char* name : {"a", "b", "c"}) EXPECT_EQ(opened(name), 0);
  EXPECT_EQ(open("z").error().code, Code::unknown_map);
}

TEST_F(KeptAtlasTest, OpensAMapOnceForAllWhoAsk) {
  const auto first = ask("b"), second = ask("b"), other = ask("c");
  context.run();
  EXPECT_TRUE(first->empty());  // not within the call, and not on a strand
  run();
  ASSERT_TRUE(first->at(0));
  EXPECT_EQ(*first->at(0), *second->at(0));
  EXPECT_EQ(opened("b"), 1);
  EXPECT_EQ(opened("a"), 0);
  EXPECT_EQ((*first->at(0))->epoch(), 0xA0u + 'b');
  EXPECT_EQ(atlas->list()[1].epoch, 0xA0u + 'b');
  EXPECT_EQ(atlas->rooms().size(), 2u);
  const auto live = ask("b");  // answered within the call
  EXPECT_EQ(*live->at(0), *first->at(0));
}

TEST_F(KeptAtlasTest, OpensFewAtATime) {
  for (int i = 0; i < 50; ++i) shelf->put("m" + std::to_string(i), {});
  start();
  for (int i = 0; i < 50; ++i) ask("m" + std::to_string(i));
  EXPECT_EQ(aside.size(), std::size_t{kMaxMapsUnderWay});
  run();
  EXPECT_EQ(atlas->rooms().size(), 50u);
}

TEST_F(KeptAtlasTest, RefusesADamagedMapAndServesTheOthers) {
  shelf->maps.at("a").broken = {Code::damaged, "a.earthwork: events, seq 7: its sum is wrong", {}};
  const auto refused = open("a");
  EXPECT_EQ(refused.error().code, Code::damaged);
  EXPECT_NE(refused.error().detail.find("seq 7"), std::string::npos);
  EXPECT_TRUE(open("b"));
  EXPECT_EQ(names_of(*atlas), "a b c ");
  const auto count = static_cast<std::size_t>(Code::damaged);
  EXPECT_EQ(atlas->meters().journal_failures[count], 1u);
}

TEST_F(KeptAtlasTest, TriesADamagedMapAgainAfterAWhile) {
  shelf->maps.at("a").broken = {Code::damaged, "damaged", {}};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(open("a").error().code, Code::damaged);
  EXPECT_EQ(opened("a"), 1);
  pass(3s);
  EXPECT_EQ(open("a").error().code, Code::damaged);
  EXPECT_EQ(opened("a"), 2);
  shelf->maps.at("a").broken.reset();
  pass(3s);
  EXPECT_TRUE(open("a"));
}

TEST_F(KeptAtlasTest, SaysThatALaterFormatIsNotSupported) {
  shelf->maps.at("a").broken = {Code::bad_version, "written by a later version", {}};
  EXPECT_EQ(open("a").error().code, Code::not_supported);
}

TEST_F(KeptAtlasTest, ForgetsAMapWhoseFileIsGone) {
  shelf->maps.erase("a");
  EXPECT_EQ(open("a").error().code, Code::unknown_map);
  EXPECT_EQ(names_of(*atlas), "b c ");
  EXPECT_TRUE(create("a"));
}

TEST_F(KeptAtlasTest, PutsAwayWhatNobodyUsesAndBringsItBack) {
  auto room = open("a").value();
  paint(*room, 1);
  pass(50s);
  EXPECT_EQ(open_now("a"), 1);
  pass(15s);
  EXPECT_EQ(open_now("a"), 0);
  EXPECT_TRUE(atlas->rooms().empty());
  EXPECT_EQ(names_of(*atlas), "a b c ");
  EXPECT_EQ(atlas->list()[0].epoch, room->epoch());

  const auto again = open("a").value();
  EXPECT_NE(again, room);
  EXPECT_EQ(again->epoch(), room->epoch());
  EXPECT_EQ(again->info().seq, 1u);
  EXPECT_EQ(again->info().hash, room->info().hash);
  EXPECT_EQ(room->join(std::make_shared<Onlooker>(), {}).error().code, Code::unavailable);
}

TEST_F(KeptAtlasTest, LeavesAMapAloneThatSomebodyIsInside) {
  const auto room = open("a").value();
  const auto viewer = room->join(std::make_shared<Onlooker>(), {}).value().viewer;
  pass(300s);
  EXPECT_EQ(open_now("a"), 1);
  room->leave(viewer);
  pass(50s);
  EXPECT_EQ(open_now("a"), 1);
  pass(15s);
  EXPECT_EQ(open_now("a"), 0);
}

TEST_F(KeptAtlasTest, AMapThatWasOnlyAskedAboutLeavesSooner) {
  ASSERT_TRUE(open("a", Atlas::Errand::question));
  ASSERT_TRUE(open("b", Atlas::Errand::question));
  ASSERT_TRUE(open("b", Atlas::Errand::visit));
  pass(10s);
  EXPECT_EQ(open_now("a"), 0);
  EXPECT_EQ(open_now("b"), 1);
}

TEST_F(KeptAtlasTest, WhoAsksForAMapThatIsBeingPutAwayWaitsForIt) {
  ASSERT_TRUE(open("a"));
  for (int i = 0; i < 65 && !atlas->rooms().empty(); ++i) context.advance(1s);
  ASSERT_TRUE(atlas->rooms().empty());
  EXPECT_EQ(open_now("a"), 1);  // its journal is yet to be closed, aside
  const auto asked = ask("a");
  EXPECT_TRUE(asked->empty());
  run();
  ASSERT_TRUE(asked->at(0));
  EXPECT_EQ(opened("a"), 2);
  EXPECT_EQ(open_now("a"), 1);
}

TEST_F(KeptAtlasTest, ARoomThatClosedItselfIsMadeAnewFromWhatWasStored) {
  const auto room = open("a").value();
  paint(*room, 1);
  shelf->maps.at("a").unwritable = {Code::bad_state, "somebody else has written", {}};
  paint(*room, 2);
  shelf->maps.at("a").unwritable.reset();
  ASSERT_TRUE(room->closed());
  atlas->let_go(*room);
  const auto again = open("a").value();
  EXPECT_NE(again, room);
  EXPECT_EQ(again->info().seq, 1u);
  atlas->let_go(*room);  // that one is gone already
  EXPECT_EQ(open("a").value(), again);
}

TEST_F(KeptAtlasTest, ARoomThatClosedItselfIsNoticedWhenNobodyComes) {
  const auto room = open("a").value();
  room->close({{Code::internal, "a mistake", "map"}, {}});
  EXPECT_EQ(open_now("a"), 1);
  pass(3s);
  EXPECT_EQ(open_now("a"), 0);
}

TEST_F(KeptAtlasTest, KeepsANewMap) {
  const auto made = create("d").value();
  paint(*made, 1);
  EXPECT_EQ(create("d").error().code, Code::map_exists);
  EXPECT_EQ(create("a").error().code, Code::map_exists);
  EXPECT_EQ(shelf->maps.at("d").journal->identity().epoch, made->epoch());
  EXPECT_EQ(shelf->maps.at("d").journal->last_seq(), 1u);
}

TEST_F(KeptAtlasTest, AMapThatCouldNotBeMadeIsNotThere) {
  shelf->full = {Code::disk_full, "no room", {}};
  EXPECT_EQ(create("d").error().code, Code::disk_full);
  EXPECT_EQ(names_of(*atlas), "a b c ");
  EXPECT_EQ(open("d").error().code, Code::unknown_map);
  shelf->full.reset();
  EXPECT_TRUE(create("d"));
}

TEST_F(KeptAtlasTest, AFileThatCameMeanwhileIsFoundByWhoWouldMakeIt) {
  shelf->put("d", {.settings = {}, .epoch = 9, .created_ms = 1});
  EXPECT_EQ(create("d").error().code, Code::map_exists);
  EXPECT_EQ(open("d").value()->epoch(), 9u);
}

TEST_F(KeptAtlasTest, AnErasedMapIsGoneOnceItsJournalIsClosed) {
  const auto room = open("a").value();
  const auto eyes = std::make_shared<Onlooker>();
  ASSERT_TRUE(room->join(eyes, {}));
  const auto erased = erase("a");
  EXPECT_EQ(names_of(*atlas), "b c ");
  EXPECT_EQ(open("z").error().code, Code::unknown_map);
  EXPECT_EQ(eyes->bye->failure.code, Code::unknown_map);
  ASSERT_EQ(erased->size(), 1u);
  EXPECT_TRUE(erased->at(0));
  EXPECT_FALSE(shelf->maps.contains("a"));
  const auto anew = create("a").value();
  EXPECT_NE(anew->epoch(), room->epoch());
  EXPECT_EQ(anew->info().seq, 0u);
}

TEST_F(KeptAtlasTest, WhileItIsErasedAMapIsNeitherFoundNorMade) {
  ASSERT_TRUE(open("a"));
  const auto erased = erase("a");
  std::optional<Opened> made;
  atlas->create("a", {}, [&](const Opened& room) { made = room; });
  EXPECT_EQ(made->error().code, Code::map_exists);
  EXPECT_EQ(ask("a")->at(0).error().code, Code::unknown_map);
  EXPECT_EQ(erase("a")->at(0).error().code, Code::unknown_map);
  EXPECT_TRUE(erased->empty());
  run();
  EXPECT_TRUE(erased->at(0));
}

TEST_F(KeptAtlasTest, ErasesMapsThatAreClosedOrDamagedOrBeingOpened) {
  const auto closed = erase("b");
  run();
  EXPECT_TRUE(closed->at(0));
  EXPECT_EQ(opened("c"), 0);

  const auto asked = ask("c");
  const auto erased = erase("c");
  EXPECT_EQ(asked->at(0).error().code, Code::unknown_map);
  run();
  EXPECT_TRUE(erased->at(0));
  EXPECT_FALSE(shelf->maps.contains("c"));
  EXPECT_EQ(names_of(*atlas), "a ");
}

TEST_F(KeptAtlasTest, AMapThatCannotBeRemovedIsStillThere) {
  shelf->maps.at("a").broken = {Code::read_only, "it may not", {}};
  const auto erased = erase("a");
  run();
  EXPECT_EQ(erased->at(0).error().code, Code::read_only);
  EXPECT_EQ(names_of(*atlas), "a b c ");
  shelf->maps.at("a").broken.reset();
  EXPECT_TRUE(open("a"));
}

TEST_F(KeptAtlasTest, StopsOnceEveryJournalIsClosed) {
  const auto room = open("a").value();
  const auto eyes = std::make_shared<Onlooker>();
  const auto viewer = room->join(eyes, {}).value().viewer;
  ASSERT_TRUE(room->submit(
      viewer, {.id = 1,
               .author = 7,
               .action = protocol::Edit{.radius = 3, .path = {{5, 5}}, .stroke = {}}}));
  context.run(1);  // its turn: it is applied
  EXPECT_FALSE(atlas->stop(0ms));
  EXPECT_EQ(open("b").error().code, Code::shutting_down);
  EXPECT_EQ(create("d").error().code, Code::shutting_down);
  run();
  EXPECT_TRUE(atlas->stop(0ms));
  EXPECT_EQ(eyes->bye->failure.code, Code::shutting_down);
  EXPECT_EQ(open_now("a"), 0);
  EXPECT_EQ(shelf->maps.at("a").journal->last_seq(), 1u);
}

TEST_F(KeptAtlasTest, WhatStopHadNoPatienceForIsWaitedForAtTheEnd) {
  auto room = open("a").value();
  const std::weak_ptr<Room> waits = room;
  shelf->hold();
  paint(*room, 1);
  room.reset();
  EXPECT_FALSE(atlas->stop(0ms));
  context.run();  // the room waits for its commit, and who waits holds the room
  EXPECT_FALSE(waits.expired());
  atlas.reset();
  EXPECT_EQ(open_now("a"), 0);
  context.run();
  EXPECT_TRUE(waits.expired());
  EXPECT_EQ(shelf->maps.at("a").journal->last_seq(), 1u);
}

TEST_F(KeptAtlasTest, ARoomThatIsPutAwayMeanwhileIsLetGoOfToo) {
  auto room = open("a").value();
  const std::weak_ptr<Room> waits = room;
  paint(*room, 1);
  shelf->hold();
  room.reset();
  pass(70s);  // its last keyframe is on its way
  EXPECT_FALSE(waits.expired());
  EXPECT_FALSE(atlas->stop(0ms));
  atlas.reset();
  context.run();
  EXPECT_TRUE(waits.expired());
  EXPECT_EQ(open_now("a"), 0);
}

TEST_F(KeptAtlasTest, LetsGoOfItsRoomsAtItsEnd) {
  auto room = open("a").value();
  atlas.reset();
  EXPECT_EQ(open_now("a"), 1);  // a room is whole as long as somebody has it
  room.reset();
  context.run();
  EXPECT_EQ(open_now("a"), 0);
}

}  // namespace
}  // namespace earthwork::room
