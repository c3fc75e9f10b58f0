// Places: one number a chunk, near ones for near chunks.
#include "server/journal/chunk_place.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace earthwork::journal {
namespace {

TEST(ChunkPlace, TakesBitsInTurns) {
  constexpr std::int64_t kOrigin = std::int64_t{7} << 60;
  EXPECT_EQ(place_of({0, 0, 0, 0}), kOrigin);
  EXPECT_EQ(place_of({3, 1, 0, 0}), kOrigin + 1);
  EXPECT_EQ(place_of({0, 0, 1, 0}), kOrigin + 2);
  EXPECT_EQ(place_of({0, 0, 0, 1}), kOrigin + 4);
  EXPECT_EQ(place_of({0, 2, 3, 0}), kOrigin + 8 + 16 + 2);
  EXPECT_EQ(place_of({0, -(1 << 20), -(1 << 20), -(1 << 20)}), 0);
  EXPECT_EQ(place_of({0, (1 << 20) - 1, (1 << 20) - 1, (1 << 20) - 1}), INT64_MAX);
}

RC_GTEST_PROP(ChunkPlace, GivesTheKeyBack, ()) {
  const auto coordinate = rc::gen::inRange(-(1 << 20), 1 << 20);
  const voxel::ChunkKey key{
      .layer = *rc::gen::inRange(0, 16), .x = *coordinate, .y = *coordinate, .z = *coordinate};
  RC_ASSERT(key_of(key.layer, place_of(key)) == key);
}

TEST(ChunkPlace, IsNotNegative) { EXPECT_EQ(key_of(0, -1), std::nullopt); }

}  // namespace
}  // namespace earthwork::journal
