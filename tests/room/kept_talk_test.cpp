// What was said stays with the map: while it is put away, and no longer than it is there.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/room/atlas.hpp"
#include "server/room/manual_context.hpp"
#include "tests/room/kept_shelf.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using Texts = std::vector<std::string>;

struct KeptTalkTest : testing::Test {
  KeptTalkTest() {
    for (const char* name : {"a", "b"})
      shelf->put(name, {.settings = {}, .epoch = 7, .created_ms = 1});
    EXPECT_TRUE(atlas.take_stock());
  }
  std::shared_ptr<Room> open(const std::string& name) {
    std::shared_ptr<Room> found;
    atlas.open(name, Atlas::Errand::visit, [&](const auto& room) { found = room.value(); });
    context.run();
    return found;
  }
  void say(const std::string& map, const std::string& text) {
    const auto room = open(map);
    const auto viewer = room->join(std::make_shared<Onlooker>(), ann).value().viewer;
    EXPECT_TRUE(room->say(viewer, text));
    context.run();
    room->leave(viewer);
  }
  /// What somebody who joins is told was said.
  Texts heard(const std::string& map) {
    const auto room = open(map);
    const auto eyes = std::make_shared<Onlooker>();
    const auto viewer = room->join(eyes, ann).value().viewer;
    context.run();
    room->leave(viewer);
    Texts texts;
    for (const auto& line : eyes->chat()) texts.push_back(std::to_string(line.n) + line.text);
    return texts;
  }
  /// Until every map is put away.
  void sleep() {
    for (int s = 0; s < 100; ++s) context.advance(1s);
    EXPECT_TRUE(atlas.rooms().empty());
  }

  const protocol::User ann{"0123456789abcdef", "ann", "#102030", "00112233445566ff"};
  ManualContext context;
  std::shared_ptr<KeptShelf> shelf = std::make_shared<KeptShelf>();
  Atlas atlas{
      {.make_strand = [this] { return context.make_strand(); }, .shelf = shelf, .idle = 60s}};
};

TEST_F(KeptTalkTest, IsThereAgainWhenItsMapWasPutAway) {
  say("a", "one"), say("a", "two");
  sleep();
  EXPECT_EQ(heard("a"), (Texts{"1one", "2two"}));
  EXPECT_EQ(heard("b"), Texts{});
  sleep();
  say("a", "three");
  EXPECT_EQ(heard("a"), (Texts{"1one", "2two", "3three"}));
  EXPECT_EQ(shelf->maps.at("a").opened, 3);
}

TEST_F(KeptTalkTest, OutlivesARoomThatClosedItself) {
  say("a", "one");
  const auto room = open("a");
  room->close({.failure = {protocol::Code::damaged, "it broke", {}}, .retry_after_ms = {}});
  atlas.let_go(*room);
  EXPECT_EQ(heard("a"), Texts{"1one"});
}

TEST_F(KeptTalkTest, GoesWithItsMap) {
  say("a", "one");
  sleep();
  bool erased = false;
  atlas.erase("a", [&](const auto& done) { erased = done.has_value(); });
  context.run();
  ASSERT_TRUE(erased);
  atlas.create("a", {}, [](const auto&) {});
  context.run();
  EXPECT_EQ(heard("a"), Texts{});
  say("a", "anew");
  EXPECT_EQ(heard("a"), Texts{"1anew"});
}

}  // namespace
}  // namespace earthwork::room
