// Events: the same list gives the same map.
#include "server/history/event.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <optional>
#include <span>
#include <vector>

#include "server/history/fold.hpp"

namespace earthwork::history {
namespace {

using protocol::Edit;
using protocol::StencilShape;

Event event(std::uint64_t seq, double x, double y, double radius, bool fill) {
  Edit edit{.fill = fill, .radius = radius, .path = {{x, y}}, .stroke = {}};
  return {.seq = seq, .time_ms = 0, .author = 0, .id = 0, .action = edit, .hash = 0};
}

rc::Gen<std::vector<Event>> some_events() {
  const auto coordinate = rc::gen::map(rc::gen::inRange(-600, 600), [](int n) { return n / 8.0; });
  const auto one = rc::gen::apply(
      [](double x, double y, int radius, bool square, bool fill) {
        Edit edit{.stencil = square ? StencilShape::square : StencilShape::circle,
                  .fill = fill,
                  .radius = radius / 8.0,
                  .path = {{x, y}},
                  .stroke = {}};
        return Event{.seq = 0, .time_ms = 0, .author = 0, .id = 0, .action = edit, .hash = 0};
      },
      coordinate, coordinate, rc::gen::inRange(0, 120), rc::gen::arbitrary<bool>(),
      rc::gen::weightedElement<bool>({{3, true}, {1, false}}));
  return rc::gen::container<std::vector<Event>>(one);
}

TEST(Events, GiveTheSameHashWheneverTheyAreReplayed) {
  EXPECT_TRUE(rc::check([] {
    const auto events = *some_events();
    voxel::Map live = make_map({}), again = make_map({});
    for (const Event& e : events) history::apply(live, e.action);
    replay(again, events);
    RC_ASSERT(live.hash() == again.hash());
  }));
}

TEST(Events, MayBeReplayedInParts) {
  EXPECT_TRUE(rc::check([] {
    const auto events = *some_events();
    const std::size_t cut = *rc::gen::inRange<std::size_t>(0, events.size() + 1);
    voxel::Map whole = make_map({}), parts = make_map({});
    replay(whole, events);
    replay(parts, std::span(events).first(cut));
    replay(parts, std::span(events).subspan(cut));
    RC_ASSERT(whole.hash() == parts.hash());
  }));
}

/// As a map would have accepted them.
void number(std::vector<Event>& events) {
  voxel::Map map = make_map({});
  std::uint64_t seq = 0;
  for (Event& e : events) {
    history::apply(map, e.action);
    e.seq = ++seq;
    e.hash = map.hash();
  }
}

TEST(Events, AreVerifiedByTheirHashes) {
  EXPECT_TRUE(rc::check([] {
    auto events = *some_events();
    number(events);
    voxel::Map map = make_map({});
    RC_ASSERT(verify(map, events) == std::nullopt);
    if (events.empty()) return;

    const auto wrong = *rc::gen::inRange<std::size_t>(0, events.size());
    events[wrong].hash ^= 1;
    voxel::Map again = make_map({});
    RC_ASSERT(verify(again, events) == wrong + 1);
  }));
}

TEST(Events, TheFirstThatDiffersIsTold) {
  std::vector<Event> events{event(1, 9, 9, 3, true), event(2, 9, 9, 2, false),
                            event(3, 9, 9, 1, true)};
  number(events);
  std::get<protocol::Edit>(events[1].action).radius =
      1;  // another edit than the one that was accepted
  voxel::Map map = make_map({});
  EXPECT_EQ(verify(map, events), 2u);
  EXPECT_EQ(map.hash(), [&] {
    voxel::Map first_two = make_map({});
    replay(first_two, std::span(events).first(2));
    return first_two.hash();
  }());  // it stopped there
}

TEST(Events, AreReplayedInOrder) {
  const std::vector<Event> fill_last{event(1, 9, 9, 4, false), event(2, 9, 9, 3, true)};
  const std::vector<Event> empty_last{event(1, 9, 9, 3, true), event(2, 9, 9, 4, false)};
  voxel::Map filled = make_map({}), emptied = make_map({});
  replay(filled, fill_last);
  replay(emptied, empty_last);
  EXPECT_GT(filled.filled_voxels(), 20u);
  EXPECT_EQ(emptied.filled_voxels(), 0u);
}

}  // namespace
}  // namespace earthwork::history
