// Scenes: frames become meshes, groups in one piece, figures always those of what is held.
#include "client/scene/scene.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <vector>

namespace earthwork::scene {
namespace {

using protocol::ChunkKey;
using protocol::ChunkMesh;
using protocol::ChunkRecord;
using protocol::Code;
using protocol::FrameEvent;
using protocol::GroupBegin;
using protocol::GroupEnd;

constexpr std::uint64_t kEpoch = 0xaa;

/// A square of `side`, one of its walls.
ChunkMesh square(std::int32_t side) {
  return {.vertices = {{0, 0}, {side, 0}, {side, side}, {0, side}},
          .triangles = {0, 1, 2, 0, 2, 3},
          .sections = {{.a = 0, .b = 1, .normal_a = {0, -32767}, .normal_b = {0, -32767}}}};
}

ChunkRecord record(std::int32_t x, std::int32_t side, std::uint64_t revision = 1) {
  return {.key = {0, x, 0, 0}, .revision = revision, .removed = false, .mesh = square(side)};
}

ChunkRecord removal(std::int32_t x, std::uint64_t revision = 2) {
  return {.key = {0, x, 0, 0}, .revision = revision, .removed = true, .mesh = {}};
}

std::uint64_t hash_of(const std::map<ChunkKey, ChunkMesh>& meshes) {
  std::uint64_t sum = 0;
  for (const auto& [key, mesh] : meshes)
    sum += protocol::mesh_hash_term(key, protocol::mesh_hash(mesh));
  return sum;
}

protocol::Result<void> take(Scene& scene, std::vector<FrameEvent> events) {
  return scene.take(events, 100);
}

TEST(Scene, AppliesFirstRecordsOnArrival) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {record(0, 10), record(1, 20)}));
  EXPECT_EQ(scene.chunks().size(), 2u);
  EXPECT_EQ(scene.chunks().at({0, 1, 0, 0}).mesh, square(20));
  EXPECT_EQ(scene.chunks().at({0, 1, 0, 0}).revision, 1u);
  EXPECT_EQ(scene.mesh_hash(), hash_of({{{0, 0, 0, 0}, square(10)}, {{0, 1, 0, 0}, square(20)}}));
}

TEST(Scene, AppliesAGroupAtItsEnd) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {record(0, 10), record(1, 20)}));
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 5, 1}, record(0, 11, 5), removal(1, 5)}));
  ASSERT_TRUE(take(scene, {record(2, 30, 5)}));
  EXPECT_EQ(scene.chunks().size(), 2u);
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, square(10));
  EXPECT_EQ(scene.seq(), 0u);

  ASSERT_TRUE(take(scene, {GroupEnd{5}}));
  EXPECT_EQ(scene.seq(), 5u);
  EXPECT_EQ(scene.chunks().size(), 2u);
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, square(11));
  EXPECT_EQ(scene.chunks().at({0, 2, 0, 0}).mesh, square(30));
  EXPECT_EQ(scene.mesh_hash(), hash_of({{{0, 0, 0, 0}, square(11)}, {{0, 2, 0, 0}, square(30)}}));
}

TEST(Scene, OfAGroupTheLastRecordOfAChunkCounts) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(
      scene, {GroupBegin{kEpoch, 2, 1}, record(0, 10), removal(0), record(0, 12), GroupEnd{2}}));
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, square(12));
}

TEST(Scene, AnEmptyGroupMovesTheSequenceOn) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 7, 1}, GroupEnd{7}}));
  EXPECT_EQ(scene.seq(), 7u);
  EXPECT_TRUE(scene.chunks().empty());
  EXPECT_EQ(scene.mesh_hash(), 0u);
}

TEST(Scene, RemovingWhatIsNotThereChangesNothing) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {record(0, 10), removal(1)}));
  EXPECT_EQ(scene.stats().chunks, 1u);
}

TEST(Scene, CountsWhatItHoldsAndWhatItReceived) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {record(0, 10), record(1, 20)}));
  ASSERT_TRUE(take(scene, {record(1, 21)}));
  EXPECT_EQ(
      scene.stats(),
      (SceneStats{
          .chunks = 2, .triangles = 4, .vertices = 8, .sections = 2, .frames = 2, .bytes = 200}));
  ASSERT_TRUE(take(scene, {removal(0), removal(1)}));
  EXPECT_EQ(
      scene.stats(),
      (SceneStats{
          .chunks = 0, .triangles = 0, .vertices = 0, .sections = 0, .frames = 3, .bytes = 300}));
  EXPECT_EQ(scene.mesh_hash(), 0u);
}

TEST(Scene, KnowsWhichViewIsComplete) {
  Scene scene;
  scene.join(kEpoch);
  EXPECT_EQ(scene.complete_view(), std::nullopt);
  scene.catch_up(3, 8);
  EXPECT_EQ(scene.complete_view(), 3u);
  EXPECT_EQ(scene.seq(), 8u);
  scene.catch_up(4, 6);  // said before a group of seq 8 was
  EXPECT_EQ(scene.seq(), 8u);
}

TEST(Scene, KeepsItsMeshesOnlyInTheirEpoch) {
  Scene scene;
  scene.join(kEpoch);
  scene.look(1, {}, {});
  ASSERT_TRUE(take(scene, {record(0, 10), GroupBegin{kEpoch, 5, 1}, GroupEnd{5}}));
  scene.catch_up(1, 5);
  scene.join(kEpoch, 5);
  EXPECT_EQ(scene.chunks().size(), 1u);
  EXPECT_EQ(scene.seq(), 5u);
  EXPECT_EQ(scene.have()->seq, 5u);
  scene.join(kEpoch + 1, 9);
  EXPECT_EQ(scene.have(), std::nullopt);
  EXPECT_TRUE(scene.chunks().empty());
  EXPECT_EQ(scene.mesh_hash(), 0u);
  EXPECT_EQ(scene.seq(), 0u);
  EXPECT_EQ(scene.epoch(), kEpoch + 1);
}

TEST(Scene, DropsAtAJoinWhatItDoesNotClaim) {
  Scene scene;
  scene.join(kEpoch);
  scene.look(1, {}, {});
  ASSERT_TRUE(take(scene, {record(0, 10), record(1, 20)}));
  EXPECT_EQ(scene.have(), std::nullopt) << "the view is not complete";
  scene.join(kEpoch, 9);
  EXPECT_TRUE(scene.chunks().empty());
  EXPECT_EQ(scene.mesh_hash(), 0u);

  ASSERT_TRUE(take(scene, {record(0, 10), record(3, 20)}));
  scene.catch_up(1, 9);
  scene.look(2, protocol::MapRect{64, 8, 120, 8}, {});  // chunks 1 to 3
  EXPECT_EQ(scene.chunks().size(), 1u);
  ASSERT_TRUE(take(scene, {record(0, 11), record(2, 30)}));
  EXPECT_EQ(scene.chunks().size(), 2u) << "chunk 0 was on its way for the view before";
  scene.join(kEpoch, 8);
  EXPECT_TRUE(scene.chunks().empty()) << "the map has not got that far";
}

TEST(Scene, AGroupOfAnotherEpochReplacesAllThereWas) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {record(0, 10), GroupBegin{kEpoch, 50, 1}, GroupEnd{50}}));
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch + 1, 2, 1}, record(1, 20)}));
  EXPECT_EQ(scene.chunks().size(), 1u);
  ASSERT_TRUE(take(scene, {GroupEnd{2}}));
  EXPECT_EQ(scene.epoch(), kEpoch + 1);
  EXPECT_EQ(scene.seq(), 2u);
  EXPECT_EQ(scene.mesh_hash(), hash_of({{{0, 1, 0, 0}, square(20)}}));
}

TEST(Scene, AJoinForgetsAGroupThatWasCutOff) {
  Scene scene;
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 5, 1}, record(0, 10)}));
  scene.join(kEpoch);
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 6, 1}, GroupEnd{6}}));
  EXPECT_TRUE(scene.chunks().empty());
}

TEST(Scene, RefusesGroupsThatAreNone) {
  const auto error_of = [](std::vector<FrameEvent> events) {
    Scene scene;
    scene.join(kEpoch);
    scene.catch_up(1, 4);
    const auto taken = take(scene, std::move(events));
    EXPECT_FALSE(taken);
    EXPECT_EQ(taken.error().code, Code::bad_frame);
    return taken.error().detail;
  };
  EXPECT_EQ(error_of({GroupBegin{kEpoch, 5, 1}, GroupBegin{kEpoch, 5, 1}}),
            "a group begins inside a group");
  EXPECT_EQ(error_of({GroupEnd{5}}), "a group ends that did not begin");
  EXPECT_EQ(error_of({GroupBegin{kEpoch, 5, 1}, GroupEnd{6}}), "a group of seq 5 ends with seq 6");
  EXPECT_EQ(error_of({GroupBegin{kEpoch, 3, 1}}), "a group goes back from seq 4 to 3");
}

TEST(Scene, HoldsAViewOfEveryLayerAndNoMore) {
  ASSERT_EQ(kMaxSceneChunks, 262'144u);
  for (const bool in_a_group : {false, true}) {
    Scene scene;
    scene.join(kEpoch);
    if (in_a_group) {
      ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 5, 1}}));
    }
    for (std::int32_t i = 0; i < 262'144; ++i) {
      ChunkRecord empty{.key = {0, i, 0, 0}, .revision = 1, .removed = false, .mesh = {}};
      ASSERT_TRUE(take(scene, {std::move(empty)}));
    }
    ASSERT_TRUE(take(scene, {record(7, 10)})) << "known already";
    const auto taken = take(scene, {record(262'144, 10)});
    ASSERT_FALSE(taken);
    EXPECT_EQ(taken.error().code, Code::too_large);
    EXPECT_EQ(taken.error().detail, "more chunks than the limit of 262144");
  }
}

/// A mesh whose walls leave something to copy: a row of `columns` squares, the last of them `side`
/// wide.
ChunkRecord row(std::int32_t side, std::uint64_t revision) {
  constexpr std::uint16_t kColumns = 40;
  ChunkMesh mesh;
  for (const std::int32_t y : {0, 1000})
    for (std::uint16_t i = 0; i <= kColumns; ++i)
      mesh.vertices.push_back({i * 1000 + (i == kColumns ? side : 0), y});
  for (std::uint16_t i = 0; i < kColumns; ++i) {
    const auto at = [i](int step) { return static_cast<std::uint16_t>(i + step); };
    mesh.triangles.insert(mesh.triangles.end(), {i, at(1), at(kColumns + 1)});
    mesh.sections.push_back({i, at(1), {0, -32767}, {0, -32767}});
  }
  return {.key = {0, 0, 0, 0}, .revision = revision, .removed = false, .mesh = std::move(mesh)};
}

protocol::ChunkDelta delta(const ChunkRecord& base, const ChunkRecord& next) {
  std::string bytes;
  EXPECT_TRUE(protocol::encode_delta(base, next, 100'000, bytes));
  return *protocol::decode_delta(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

TEST(Scene, ADeltaChangesTheMeshThatIsHeld) {
  Scene scene;
  scene.join(kEpoch, 0);
  ASSERT_TRUE(take(scene, {row(1, 1), record(1, 20)}));
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 5, 1}, delta(row(1, 1), row(2, 5))}));
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, row(1, 1).mesh) << "before the group's end";
  ASSERT_TRUE(take(scene, {GroupEnd{5}}));
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, row(2, 5).mesh);
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).revision, 5u);
  EXPECT_EQ(scene.mesh_hash(),
            hash_of({{{0, 0, 0, 0}, row(2, 5).mesh}, {{0, 1, 0, 0}, square(20)}}));
}

TEST(Scene, ADeltaChangesWhatItsGroupBrought) {
  Scene scene;
  scene.join(kEpoch, 0);
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 7, 1}, row(1, 4), delta(row(1, 4), row(2, 5)),
                           delta(row(2, 5), row(3, 7)), GroupEnd{7}}));
  EXPECT_EQ(scene.chunks().at({0, 0, 0, 0}).mesh, row(3, 7).mesh);
}

TEST(Scene, RefusesADeltaWhoseBaseItDoesNotHold) {
  const auto error_of = [](std::vector<FrameEvent> events) {
    Scene scene;
    scene.join(kEpoch, 0);
    const auto taken = take(scene, std::move(events));
    EXPECT_FALSE(taken);
    EXPECT_EQ(taken.error().code, Code::bad_frame);
    return taken.error().detail;
  };
  const GroupBegin begin{kEpoch, 9, 1};
  const auto change = delta(row(1, 4), row(2, 5));
  EXPECT_EQ(error_of({row(1, 4), change}), "a delta comes outside a group");
  const std::string none = "base revision: no mesh of 4 is held";
  EXPECT_EQ(error_of({begin, change}), none);
  EXPECT_EQ(error_of({row(1, 3), begin, change}), none);
  EXPECT_EQ(error_of({row(1, 4), begin, removal(0), change}), none);
  EXPECT_EQ(error_of({row(1, 4), begin, row(1, 6), change}), none);
  EXPECT_EQ(error_of({row(1, 4), GroupBegin{kEpoch + 1, 9, 1}, change}), none);
  auto broken = change;
  broken.operations.pop_back();
  EXPECT_EQ(error_of({row(1, 4), begin, broken}), "delta: ends early, or has a bad varint");
}

TEST(Scene, LetsADeltaOfAnEarlierViewGo) {
  Scene scene;
  scene.join(kEpoch, 0);
  const auto change = delta(row(1, 4), row(2, 5));
  const protocol::MapRect here{0, 0, 10, 10}, elsewhere{500, 500, 510, 510};
  scene.look(1, here, {});
  ASSERT_TRUE(take(scene, {row(1, 4)}));
  scene.look(2, elsewhere, {});
  ASSERT_TRUE(take(scene, {GroupBegin{kEpoch, 5, 1}, change})) << "outside the view";
  scene.look(3, here, {});
  ASSERT_TRUE(take(scene, {change, GroupEnd{5}})) << "its chunk was let go";
  EXPECT_TRUE(scene.chunks().empty());
  EXPECT_FALSE(take(scene, {GroupBegin{kEpoch, 6, 3}, change}));
}

RC_GTEST_PROP(Scene, FiguresAreThoseOfItsMeshes, ()) {
  Scene scene;
  scene.join(kEpoch);
  std::map<ChunkKey, ChunkMesh> expected;
  std::uint64_t seq = 0;
  for (int messages = *rc::gen::inRange(1, 30); messages > 0; --messages) {
    const bool group = *rc::gen::arbitrary<bool>();
    std::vector<FrameEvent> events;
    if (group) events.emplace_back(GroupBegin{kEpoch, ++seq, 1});
    for (int records = *rc::gen::inRange(0, 5); records > 0; --records) {
      const auto x = *rc::gen::inRange<std::int32_t>(0, 6);
      const auto side = *rc::gen::inRange<std::int32_t>(0, 5);
      const ChunkRecord r = side == 0 ? removal(x, seq) : record(x, side, seq);
      expected.erase(r.key);
      if (!r.removed) expected.emplace(r.key, r.mesh);
      events.emplace_back(r);
    }
    if (group) events.emplace_back(GroupEnd{seq});
    RC_ASSERT(bool(scene.take(events, 1)));

    RC_ASSERT(scene.mesh_hash() == hash_of(expected));
    RC_ASSERT(scene.chunks().size() == expected.size());
    RC_ASSERT(scene.stats().vertices == 4 * expected.size());
    RC_ASSERT(scene.stats().triangles == 2 * expected.size());
    RC_ASSERT(scene.stats().chunks == expected.size());
    for (const auto& [key, mesh] : expected) RC_ASSERT(scene.chunks().at(key).mesh == mesh);
  }
}

}  // namespace
}  // namespace earthwork::scene
