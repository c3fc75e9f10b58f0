// Lists of what changed: in order, each chunk once, and added up.
#include "server/voxel/change.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace earthwork::voxel {
namespace {

TEST(Change, PutInOrderRunsFromTheTopRightAndNamesAChunkOnce) {
  Change change{.changed = {{0, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}},
                .dirty = {{{0, 0, 0, 0}, {1, 1, 2, 2}},
                          {{0, 0, 1, 0}, {0, 0, 8, 8}},
                          {{0, 0, 0, 0}, {3, 0, 4, 1}}}};
  put_in_order(change);
  const Change expected{.changed = {{0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}},
                        .dirty = {{{0, 0, 1, 0}, {0, 0, 8, 8}}, {{0, 0, 0, 0}, {1, 0, 4, 2}}}};
  EXPECT_EQ(change, expected);
}

TEST(Change, AddsUpToTheChangeOfBoth) {
  EXPECT_TRUE(rc::check([] {
    const auto some = [] {
      Change change;
      for (int n = *rc::gen::inRange(0, 12); n > 0; --n) {
        const ChunkKey key{0, *rc::gen::inRange(-2, 3), *rc::gen::inRange(-2, 3), 0};
        const int x = *rc::gen::inRange(0, 8), y = *rc::gen::inRange(0, 8);
        if (*rc::gen::arbitrary<bool>()) change.changed.push_back(key);
        change.dirty.push_back({key, {x, y, x + 1, y + 2}});
      }
      return change;
    };
    Change all = some(), more = some(), both = all;
    both.changed.insert(both.changed.end(), more.changed.begin(), more.changed.end());
    both.dirty.insert(both.dirty.end(), more.dirty.begin(), more.dirty.end());
    put_in_order(all), put_in_order(more), put_in_order(both);
    add(all, more);
    RC_ASSERT(all == both);
  }));
}

}  // namespace
}  // namespace earthwork::voxel
