// What a scene tells a drawing of it: what the drawing needs to become what the scene holds.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <vector>

#include "client/scene/scene.hpp"

namespace earthwork::scene {
namespace {

using protocol::ChunkKey;
using protocol::ChunkRecord;
using protocol::FrameEvent;
using protocol::GroupBegin;
using protocol::GroupEnd;

using Keys = std::vector<ChunkKey>;

ChunkKey key(std::int32_t x) { return {0, x, 0, 0}; }

ChunkRecord record(std::int32_t x, std::uint64_t revision) {
  ChunkRecord record{.key = key(x), .revision = revision, .removed = false, .mesh = {}};
  record.mesh.vertices = {{0, 0}, {9, 0}, {9, 9}};
  record.mesh.triangles = {0, 1, 2};
  return record;
}

ChunkRecord removal(std::int32_t x, std::uint64_t revision) {
  return {.key = key(x), .revision = revision, .removed = true, .mesh = {}};
}

void feed(Scene& scene, std::vector<FrameEvent> events) { ASSERT_TRUE(scene.take(events, 100)); }

Scene with_two_chunks() {
  Scene scene;
  scene.join(1);
  feed(scene, {record(4, 1), record(3, 1)});
  return scene;
}

TEST(SceneChanges, AreAllThatIsHeldAtFirst) {
  Scene scene = with_two_chunks();
  EXPECT_TRUE(scene.changed());
  EXPECT_EQ(scene.take_changed(), (SceneChanges{.keys = {key(3), key(4)}, .all = true}));
  EXPECT_FALSE(scene.changed());
  EXPECT_EQ(scene.take_changed(), SceneChanges{});
}

TEST(SceneChanges, AreNewDifferentAndGoneChunksEachOnce) {
  Scene scene = with_two_chunks();
  (void)scene.take_changed();
  feed(scene, {record(7, 2), record(4, 2), record(4, 3), removal(3, 3), removal(8, 3)});
  EXPECT_TRUE(scene.changed());
  EXPECT_EQ(scene.take_changed(), (SceneChanges{.keys = {key(3), key(4), key(7)}, .all = false}));
}

TEST(SceneChanges, ComeAtTheEndOfAGroup) {
  Scene scene = with_two_chunks();
  (void)scene.take_changed();
  feed(scene, {GroupBegin{1, 5, 0}, record(4, 5)});
  EXPECT_FALSE(scene.changed());
  feed(scene, {GroupEnd{5}});
  EXPECT_EQ(scene.take_changed().keys, Keys{key(4)});
}

TEST(SceneChanges, NameWhatAViewLetsGo) {
  Scene scene = with_two_chunks();
  (void)scene.take_changed();
  scene.look(1, protocol::MapRect{100, 1, 110, 2}, {});
  EXPECT_EQ(scene.take_changed(), (SceneChanges{.keys = {key(4)}, .all = false}));
}

TEST(SceneChanges, AreAllWhenAnotherMapComes) {
  Scene scene = with_two_chunks();
  (void)scene.take_changed();
  feed(scene, {GroupBegin{2, 1, 0}, record(9, 1), GroupEnd{1}});
  EXPECT_EQ(scene.take_changed(), (SceneChanges{.keys = {key(9)}, .all = true}));
}

TEST(SceneChanges, AreAllWhenTheyAreTooMany) {
  Scene scene = with_two_chunks();
  (void)scene.take_changed();
  // One chunk at a time is held, and as many as may be noted come and go.
  for (std::size_t i = 0; i < kMaxSceneChunks; ++i) {
    const auto x = static_cast<std::int32_t>(i);
    feed(scene, {record(x, 2), removal(x, 3)});
  }
  EXPECT_FALSE(scene.take_changed().all);
  for (std::size_t i = 0; i <= kMaxSceneChunks; ++i) {
    const auto x = static_cast<std::int32_t>(i);
    feed(scene, {record(x, 4), removal(x, 5)});
  }
  feed(scene, {record(2, 6)});
  EXPECT_EQ(scene.take_changed(), (SceneChanges{.keys = {key(2)}, .all = true}));
}

RC_GTEST_PROP(SceneChanges, KeepADrawingWhatTheSceneIs, ()) {
  Scene scene;
  scene.join(1);
  std::map<ChunkKey, std::uint64_t> drawn;
  std::uint64_t revision = 0;
  const int steps = *rc::gen::inRange(1, 60);
  for (int i = 0; i < steps; ++i) {
    ++revision;
    const auto x = *rc::gen::inRange(0, 6);
    const int what = *rc::gen::inRange(0, 7);
    if (what < 3) feed(scene, {record(x, revision)});
    if (what == 3) feed(scene, {removal(x, revision)});
    if (what == 4)
      feed(scene, {GroupBegin{revision, revision, 0}, record(x, 1), GroupEnd{revision}});
    if (what == 5) scene.look(1, protocol::MapRect{32.0 * x + 1, 1, 32.0 * x + 60, 2}, {});
    if (what < 6) continue;
    const SceneChanges changes = scene.take_changed();
    if (changes.all) drawn.clear();
    for (const ChunkKey& at : changes.keys) {
      const auto held = scene.chunks().find(at);
      if (held == scene.chunks().end())
        drawn.erase(at);
      else
        drawn[at] = held->second.revision;
    }
    std::map<ChunkKey, std::uint64_t> held;
    for (const auto& [at, chunk] : scene.chunks()) held[at] = chunk.revision;
    RC_ASSERT(drawn == held);
  }
}

}  // namespace
}  // namespace earthwork::scene
