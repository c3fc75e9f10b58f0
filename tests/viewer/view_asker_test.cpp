// Which part of a map is asked for, and when it is asked for again.
#include "client/viewer/view_asker.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocol/limits.hpp"

namespace earthwork::viewer {
namespace {

using namespace std::chrono_literals;
using protocol::MapRect;
using protocol::MapSettings;

const ViewAsker::Time kStart{};

MapSettings bounded(std::int32_t chunks) {
  MapSettings settings;
  settings.chunks = {-chunks, -chunks, chunks, chunks};
  return settings;
}

MapRect around(double x, double y, double reach) {
  return {x - reach, y - reach, x + reach, y + reach};
}

TEST(ViewAsker, AsksForWhatIsSeenAndAMargin) {
  ViewAsker asker;
  const auto view = asker.ask({0, 0, 100, 50}, {50, 25}, MapSettings{}, kStart);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->n, 1u);
  EXPECT_EQ(view->rect, (MapRect{-30, -15, 130, 65}));
  EXPECT_EQ(asker.last(), 1u);
  EXPECT_EQ(asker.rect(), *view->rect);
}

TEST(ViewAsker, ASmallPanAsksForNothing) {
  ViewAsker asker;
  ASSERT_TRUE(asker.ask(around(0, 0, 100), {0, 0}, MapSettings{}, kStart));
  EXPECT_FALSE(asker.ask(around(40, -40, 100), {40, -40}, MapSettings{}, kStart + 1s));
  EXPECT_FALSE(asker.due());
  const auto view = asker.ask(around(130, 0, 100), {130, 0}, MapSettings{}, kStart + 2s);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->n, 2u);
}

TEST(ViewAsker, AsksAtMostAFewTimesASecond) {
  ViewAsker asker;
  ASSERT_TRUE(asker.ask(around(0, 0, 100), {0, 0}, MapSettings{}, kStart));
  EXPECT_FALSE(asker.ask(around(900, 0, 100), {900, 0}, MapSettings{}, kStart + 249ms));
  EXPECT_EQ(asker.due(), kStart + 250ms);
  EXPECT_TRUE(asker.ask(around(900, 0, 100), {900, 0}, MapSettings{}, kStart + 250ms));
  EXPECT_FALSE(asker.due());
}

TEST(ViewAsker, AsksForLessWhenMuchLessIsSeen) {
  ViewAsker asker;
  ASSERT_TRUE(asker.ask(around(0, 0, 1000), {0, 0}, MapSettings{}, kStart));
  EXPECT_FALSE(asker.ask(around(0, 0, 700), {0, 0}, MapSettings{}, kStart + 1s));
  EXPECT_TRUE(asker.ask(around(0, 0, 100), {0, 0}, MapSettings{}, kStart + 2s));
  // A few chunks are not worth it.
  EXPECT_FALSE(asker.ask(around(0, 0, 1), {0, 0}, MapSettings{}, kStart + 3s));
}

TEST(ViewAsker, OfABoundedMapAsksForNothingBeyond) {
  ViewAsker asker;
  const auto view = asker.ask(around(0, 0, 1e6), {0, 0}, bounded(4), kStart);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->rect, (MapRect{-127.5, -127.5, 128.5, 128.5}));
  EXPECT_FALSE(asker.ask(around(5e5, 0, 1e5), {5e5, 0}, bounded(4), kStart + 1s));
}

TEST(ViewAsker, OfTooLargeAPartAsksForTheMiddle) {
  ViewAsker asker;
  const auto view = asker.ask(around(5000, 0, 50'000), {5000, 0}, MapSettings{}, kStart);
  ASSERT_TRUE(view);
  const auto range = protocol::chunks_of_cells(*view->rect, MapSettings{});
  EXPECT_LE(range.count(), protocol::kMaxViewChunks);
  EXPECT_GE(range.count(), protocol::kMaxViewChunks * 9 / 10);
  EXPECT_DOUBLE_EQ(view->rect->x0 + view->rect->x1, 10'000);
  EXPECT_FALSE(asker.ask(around(5300, 0, 50'000), {5300, 0}, MapSettings{}, kStart + 1s));
  EXPECT_TRUE(asker.ask(around(9000, 0, 50'000), {9000, 0}, MapSettings{}, kStart + 2s));
}

TEST(ViewAsker, ForAnotherMapAsksAtOnceUnderTheNextNumber) {
  ViewAsker asker;
  ASSERT_TRUE(asker.ask(around(0, 0, 100), {0, 0}, MapSettings{}, kStart));
  asker.forget();
  const auto view = asker.ask(around(0, 0, 100), {0, 0}, MapSettings{}, kStart);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->n, 2u);
}

RC_GTEST_PROP(ViewAsker, HoldsWhatIsSeenOrAsManyChunksAsItMay, ()) {
  MapSettings settings;
  settings.chunk_resolution = *rc::gen::element(8, 16, 32, 64);
  settings.voxel_size = *rc::gen::element(0.25, 1.0, 8.0);
  if (*rc::gen::arbitrary<bool>()) settings.chunks = {-70, -3, 300, 900};
  ViewAsker asker;
  ViewAsker::Time now = kStart;
  for (int i = 0; i < 20; ++i) {
    const double x = *rc::gen::inRange(-2'000'000, 2'000'000),
                 y = *rc::gen::inRange(-2'000'000, 2'000'000);
    const double width = *rc::gen::inRange(1, 3'000'000), height = *rc::gen::inRange(1, 3'000'000);
    const MapRect seen{x, y, x + width, y + height};
    const auto view = asker.ask(seen, {x + width / 2, y + height / 2}, settings, now);
    now += 1s;
    if (view) RC_ASSERT(protocol::check_view(*view, settings));
    if (view) RC_ASSERT(view->rect->x0 <= view->rect->x1 && view->rect->y0 <= view->rect->y1);
    const auto there = protocol::chunks_of_cells(asker.rect(), settings);
    const auto wanted = protocol::chunks_of_cells(seen, settings);
    if (wanted.count() <= protocol::kMaxViewChunks / 16)
      RC_ASSERT(wanted.empty() || protocol::intersection(there, wanted) == wanted);
    RC_ASSERT(!asker.ask(seen, {x + width / 2, y + height / 2}, settings, now));
  }
}

}  // namespace
}  // namespace earthwork::viewer
