// A keyframe in one go: what it puts is what changed since the one before.
#include "server/journal/whole_keyframe.hpp"

#include <gtest/gtest.h>

#include "server/journal/audit.hpp"
#include "tests/journal/logs.hpp"

namespace earthwork::journal {
namespace {

TEST(WholeKeyframe, HasEveryChunkAndAuthor) {
  const auto journal = journal_of(ten_events(), {10});
  EXPECT_EQ(journal->keyframes().value(),
            (std::vector<Keyframe>{{.seq = 10,
                                    .map_hash = ten_events()[9].hash,
                                    .time_ms = 1700000000100,
                                    .settings = small_identity().settings}}));
  EXPECT_EQ(journal->authors()->size(), 3u);
  EXPECT_TRUE(audit(*journal)->sound());
}

TEST(WholeKeyframe, PutsWhatChangedSinceTheLastOne) {
  const auto journal = journal_of(ten_events(), {9, 10});
  std::vector<voxel::ChunkKey> changed;
  ASSERT_TRUE(journal->chunks(10, [&](const ChunkState& state) -> protocol::Result<void> {
    if (state.seq == 10) changed.push_back(state.key);
    return {};
  }));
  EXPECT_FALSE(changed.empty());
  for (const auto& key : changed) EXPECT_TRUE(key.x == 2 || key.x == 3 || key.x == 4) << key.x;
}

TEST(WholeKeyframe, IsPutOnce) {
  const auto journal = journal_of(ten_events(), {10});
  Execution executed(small_identity().settings);
  for (const auto& event : ten_events()) ASSERT_TRUE(executed.apply(event));
  EXPECT_TRUE(put_whole_keyframe(*journal, executed, 5));
  EXPECT_EQ(journal->keyframes()->size(), 1u);
}

TEST(WholeKeyframe, OfAnEmptyMapIsNone) {
  const auto journal = journal_of({});
  EXPECT_TRUE(put_whole_keyframe(*journal, Execution(small_identity().settings), 5));
  EXPECT_TRUE(journal->keyframes()->empty());
}

TEST(WholeKeyframe, MayHaveManyChunks) {
  const auto journal = journal_of(accepted({disc(0, 0, 150), disc(400, 0, 150)}), {2});
  std::size_t count = 0;
  ASSERT_TRUE(journal->chunks(2, [&](const ChunkState&) -> protocol::Result<void> {
    ++count;
    return {};
  }));
  EXPECT_GT(count, 2048u);
  EXPECT_TRUE(audit(*journal)->sound());
}

}  // namespace
}  // namespace earthwork::journal
