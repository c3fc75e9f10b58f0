// The atlas: maps by name.
#include "server/room/atlas.hpp"

#include <gtest/gtest.h>

#include "server/room/manual_context.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

struct AtlasTest : testing::Test {
  ManualContext context;
  Atlas atlas{[this] { return context.make_strand(); }};
};

TEST_F(AtlasTest, MakesAndFindsMaps) {
  const auto made = atlas.create("a-1_b", {.chunk_resolution = 16, .chunks = {}});
  ASSERT_TRUE(made);
  EXPECT_EQ(atlas.find("a-1_b"), *made);
  EXPECT_EQ((*made)->settings().chunk_resolution, 16);
  EXPECT_EQ(atlas.find("a-1"), nullptr);
}

TEST_F(AtlasTest, GivesEveryMapAnEpochOfItsOwn) {
  EXPECT_NE(atlas.create("a", {}).value()->epoch(), atlas.create("b", {}).value()->epoch());
}

TEST_F(AtlasTest, RefusesAKnownNameAndABadOne) {
  ASSERT_TRUE(atlas.create("a", {}));
  EXPECT_EQ(atlas.create("a", {}).error().code, Code::map_exists);
  EXPECT_EQ(atlas.create("A", {}).error().code, Code::bad_name);
  EXPECT_EQ(atlas.create("", {}).error().code, Code::bad_name);
  EXPECT_TRUE(atlas.create(std::string(64, 'x'), {}));
  EXPECT_EQ(atlas.create(std::string(65, 'x'), {}).error().code, Code::bad_name);
}

TEST_F(AtlasTest, ListsInOrder) {
  ASSERT_TRUE(atlas.create("b", {}) && atlas.create("a", {}) && atlas.create("c", {}));
  std::string names;
  for (const auto& room : atlas.list()) names += room->name();
  EXPECT_EQ(names, "abc");
}

TEST_F(AtlasTest, SaysByeToTheViewersOfAnErasedMap) {
  const auto room = atlas.create("a", {}).value();
  const auto eyes = std::make_shared<Onlooker>();
  ASSERT_TRUE(room->join(eyes, {}));
  EXPECT_TRUE(atlas.erase("a"));
  context.run();
  ASSERT_TRUE(eyes->bye);
  EXPECT_EQ(eyes->bye->failure.code, Code::unknown_map);
  EXPECT_EQ(atlas.find("a"), nullptr);
  EXPECT_FALSE(atlas.erase("a"));
  EXPECT_TRUE(atlas.create("a", {}));
}

TEST_F(AtlasTest, HasALimit) {
  for (std::size_t i = 0; i < kMaxMaps; ++i) ASSERT_TRUE(atlas.create("m" + std::to_string(i), {}));
  EXPECT_EQ(atlas.create("one-more", {}).error().code, Code::too_large);
  ASSERT_TRUE(atlas.erase("m7"));
  EXPECT_TRUE(atlas.create("one-more", {}));
}

}  // namespace
}  // namespace earthwork::room
