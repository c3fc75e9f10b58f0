// Values that copies share until one changes.
#include "server/voxel/copy_on_write.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace earthwork::voxel {
namespace {

using Shared = CopyOnWrite<std::vector<int>>;

TEST(CopyOnWrite, HoldsNothingAtFirst) {
  Shared nothing;
  EXPECT_FALSE(nothing);
  const Shared copy = nothing;
  EXPECT_FALSE(copy);
  nothing.reset();
  EXPECT_FALSE(nothing);
}

TEST(CopyOnWrite, CopiesAreOneUntilOneChanges) {
  Shared a{std::vector{1, 2, 3}};
  const Shared b = a;
  EXPECT_EQ(&*a, &*b);
  a.own().push_back(4);
  EXPECT_EQ(*a, (std::vector{1, 2, 3, 4}));
  EXPECT_EQ(*b, (std::vector{1, 2, 3}));
}

TEST(CopyOnWrite, IsChangedInPlaceWhenNobodySharesIt) {
  Shared a{std::vector{1, 2, 3}};
  const std::vector<int>* place = &*a;
  a.own()[0] = 7;
  EXPECT_EQ(&*a, place);
  Shared b = a;
  b.reset();
  a.own()[0] = 8;
  EXPECT_EQ(&*a, place);
  b = std::move(a);
  EXPECT_FALSE(a);
  b.own()[0] = 9;
  EXPECT_EQ(&*b, place);
}

TEST(CopyOnWrite, LetsGoOfTheValueWithItsLastCopy) {
  const auto watched = std::make_shared<int>(7);
  CopyOnWrite<std::shared_ptr<int>> a{watched};
  {
    auto b = a, c = b;
    c = std::move(b);
    const auto& same = c;
    c = same;
    EXPECT_EQ(watched.use_count(), 2);
    c.own();
    EXPECT_EQ(watched.use_count(), 3);
  }
  EXPECT_EQ(watched.use_count(), 2);
  a = {};
  EXPECT_EQ(watched.use_count(), 1);
}

/// One goes on changing it, others read what they were given and let go when they like.
TEST(CopyOnWrite, IsReadOnOneThreadAndChangedOnAnother) {
  Shared live{std::vector<int>(64, 0)};
  for (int round = 1; round <= 200; ++round) {
    int first = 0, last = 0;
    std::thread reader([kept = live, &first, &last]() mutable {
      first = kept->front(), last = kept->back();
      kept.reset();
    });
    for (int& value : live.own()) value = round;
    reader.join();
    EXPECT_EQ(first, round - 1);
    EXPECT_EQ(last, round - 1);
  }
}

}  // namespace
}  // namespace earthwork::voxel
