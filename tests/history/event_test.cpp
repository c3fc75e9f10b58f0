// Events: the same list gives the same map.
#include "server/history/event.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "server/history/fold.hpp"

namespace earthwork::history {
namespace {

using protocol::Edit;
using protocol::StencilShape;

Event event(std::uint64_t seq, double x, double y, double radius, bool fill) {
  Edit edit{.fill = fill, .radius = radius, .path = {{x, y}}, .stroke = {}};
  return {.seq = seq, .time_ms = 0, .author = 0, .edit = edit};
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
        return Event{.seq = 0, .time_ms = 0, .author = 0, .edit = edit};
      },
      coordinate, coordinate, rc::gen::inRange(0, 120), rc::gen::arbitrary<bool>(),
      rc::gen::weightedElement<bool>({{3, true}, {1, false}}));
  return rc::gen::container<std::vector<Event>>(one);
}

TEST(Events, GiveTheSameHashWheneverTheyAreReplayed) {
  rc::check([] {
    const auto events = *some_events();
    voxel::Map live = make_map({}), again = make_map({});
    for (const Event& e : events) apply(live, e.edit);
    replay(again, events);
    RC_ASSERT(live.hash() == again.hash());
  });
}

TEST(Events, MayBeReplayedInParts) {
  rc::check([] {
    const auto events = *some_events();
    const std::size_t cut = *rc::gen::inRange<std::size_t>(0, events.size() + 1);
    voxel::Map whole = make_map({}), parts = make_map({});
    replay(whole, events);
    replay(parts, std::span(events).first(cut));
    replay(parts, std::span(events).subspan(cut));
    RC_ASSERT(whole.hash() == parts.hash());
  });
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
