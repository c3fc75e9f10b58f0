// A hand: sequences of pointers and wheels, and what comes of them.
#include "client/viewer/hand.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace earthwork::viewer {
namespace {

using protocol::MapPoint;
using scene::ScreenPoint;
using Act = BrushAct::Kind;
using std::chrono::milliseconds;

constexpr Modifiers kShift{.shift = true}, kControl{.control = true}, kAlt{.alt = true};

/// A hand over a picture of 800 x 600 pixels, 10 of them a map unit: 0 is in the middle.
class HandTest : public testing::Test {
 protected:
  HandTest() {
    camera.resize({800, 600});
    camera.set({.target = {0, 0}, .zoom = 10});
  }

  HandOutcome send(const PointerEvent& event) {
    return hand.pointer(event, {.camera = camera, .tool = tool, .height = height}, now);
  }
  HandOutcome mouse(PointerPhase phase, ScreenPoint at, PointerButton button = PointerButton::none,
                    Modifiers modifiers = {}) {
    return send({.phase = phase, .id = 1, .button = button, .at = at, .modifiers = modifiers});
  }
  HandOutcome press(ScreenPoint at, PointerButton button = PointerButton::left,
                    Modifiers modifiers = {}) {
    return mouse(PointerPhase::press, at, button, modifiers);
  }
  HandOutcome move(ScreenPoint at) { return mouse(PointerPhase::move, at); }
  HandOutcome release(ScreenPoint at, PointerButton button = PointerButton::left) {
    return mouse(PointerPhase::release, at, button);
  }
  HandOutcome finger(PointerPhase phase, std::int32_t id, ScreenPoint at) {
    return send({.phase = phase, .kind = PointerKind::touch, .id = id, .at = at, .modifiers = {}});
  }
  HandOutcome wheel(double dx, double dy, Modifiers modifiers = {}, ScreenPoint at = {400, 300}) {
    return hand.wheel({.at = at, .dx = dx, .dy = dy, .modifiers = modifiers}, camera);
  }
  MapPoint under(ScreenPoint at) const { return camera.ground(at).value(); }

  scene::Camera camera;
  Tool tool = Tool::paint;
  double height = 0;
  Hand::Time now{};
  Hand hand;
};

void expect_acts(const HandOutcome& out, const std::vector<BrushAct>& expected) {
  ASSERT_EQ(out.brush.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(out.brush[i].kind, expected[i].kind) << i;
    EXPECT_NEAR(out.brush[i].at.x, expected[i].at.x, 1e-9) << i;
    EXPECT_NEAR(out.brush[i].at.y, expected[i].at.y, 1e-9) << i;
  }
}

void expect_point(const MapPoint& at, const MapPoint& expected) {
  EXPECT_NEAR(at.x, expected.x, 1e-9);
  EXPECT_NEAR(at.y, expected.y, 1e-9);
}

TEST_F(HandTest, PaintsWithTheLeftButton) {
  expect_acts(press({400, 300}), {{Act::begin, {0, 0}}});
  EXPECT_TRUE(hand.paints());
  expect_acts(move({420, 300}), {{Act::draw, {2, 0}}});
  const HandOutcome last = release({420, 290});
  expect_acts(last, {{Act::draw, {2, 1}}, {Act::end}});
  EXPECT_FALSE(last.camera_moved);
  EXPECT_FALSE(hand.paints());
  expect_acts(move({500, 300}), {});
}

TEST_F(HandTest, AClickIsABeginAndAnEnd) {
  expect_acts(press({410, 300}), {{Act::begin, {1, 0}}});
  expect_acts(release({410, 300}), {{Act::end}});
}

TEST_F(HandTest, PaintsOnThePlaneOfTheBrush) {
  height = camera.eye().z / 2;  // half as far, so half as large
  expect_acts(press({420, 300}), {{Act::begin, {1, 0}}});
}

TEST_F(HandTest, PaintsNothingWhereThePlaneIsNotSeen) {
  height = camera.eye().z + 1;
  expect_acts(press({420, 300}), {});
  expect_acts(move({430, 300}), {});
  expect_acts(release({430, 300}), {});
  height = 0;
  expect_acts(press({400, 300}), {{Act::begin, {0, 0}}});
  height = camera.eye().z + 1;
  expect_acts(move({430, 300}), {});
  expect_acts(release({430, 300}), {{Act::end}});
}

TEST_F(HandTest, ShowsTheBrushUnderTheMouseUntilItLeaves) {
  EXPECT_EQ(hand.over(), std::nullopt);
  move({10, 20});
  EXPECT_EQ(hand.over(), (ScreenPoint{10, 20}));
  press({30, 20});
  move({40, 20});
  EXPECT_EQ(hand.over(), (ScreenPoint{40, 20}));
  mouse(PointerPhase::leave, {40, 20});
  EXPECT_EQ(hand.over(), (ScreenPoint{40, 20})) << "a drag goes on outside";
  release({50, 20});
  EXPECT_EQ(hand.over(), (ScreenPoint{50, 20}));
  mouse(PointerPhase::leave, {0, 20});
  EXPECT_EQ(hand.over(), std::nullopt);
}

TEST_F(HandTest, MovesTheMapInManyWays) {
  struct Way {
    PointerButton button;
    Modifiers modifiers;
    bool space;
    Tool tool;
  };
  for (const Way& way : {Way{PointerButton::middle, {}, false, Tool::paint},
                         Way{PointerButton::left, kShift, false, Tool::paint},
                         Way{PointerButton::left, {}, true, Tool::paint},
                         Way{PointerButton::left, {}, false, Tool::move}}) {
    camera.set({.target = {0, 0}, .zoom = 10});
    tool = way.tool;
    hand.set_space(way.space);
    EXPECT_EQ(press({400, 300}, way.button, way.modifiers), HandOutcome{});
    hand.set_space(false);  // counts for drags that begin
    const HandOutcome moved = move({430, 310});
    EXPECT_TRUE(moved.camera_moved);
    EXPECT_TRUE(moved.brush.empty());
    expect_point(under({430, 310}), {0, 0});
    release({430, 310}, way.button);
    EXPECT_FALSE(move({500, 500}).camera_moved);
  }
}

TEST_F(HandTest, TurnsAndTiltsWithTheRightButtonOrAlt) {
  for (const bool right : {true, false}) {
    camera.set({.target = {0, 0}, .zoom = 10});
    const auto button = right ? PointerButton::right : PointerButton::left;
    press({400, 300}, button, right ? Modifiers{} : kAlt);
    EXPECT_TRUE(move({300, 200}).camera_moved);
    EXPECT_NEAR(camera.place().yaw, 0.8, 1e-9);
    EXPECT_NEAR(camera.place().tilt, 0.6, 1e-9);
    expect_point(camera.place().target, {0, 0});
    release({300, 200}, button);
  }
}

TEST_F(HandTest, NearGroundGoesWithAPointerThatTurns) {
  camera.orbit(0, 1);
  const MapPoint held = under({400, 500});
  press({400, 500}, PointerButton::right);
  move({420, 500});
  EXPECT_GT(camera.screen({held.x, held.y, 0})->x, 400);
}

TEST_F(HandTest, IgnoresAnotherButtonWhileItDrags) {
  press({400, 300});
  EXPECT_EQ(press({400, 300}, PointerButton::right), HandOutcome{});
  expect_acts(move({410, 300}), {{Act::draw, {1, 0}}});
  EXPECT_EQ(release({410, 300}, PointerButton::right), HandOutcome{});
  EXPECT_TRUE(hand.paints());
  expect_acts(release({410, 300}), {{Act::end}});
  EXPECT_EQ(release({410, 300}, PointerButton::middle), HandOutcome{});
}

TEST_F(HandTest, AButtonPressedTwiceWasReleasedUnseen) {
  press({400, 300});
  expect_acts(press({420, 300}), {{Act::end}, {Act::begin, {2, 0}}});
  expect_acts(release({420, 300}), {{Act::end}});
}

TEST_F(HandTest, AButtonThatIsNoneDoesNothing) {
  EXPECT_EQ(press({400, 300}, PointerButton::none), HandOutcome{});
  EXPECT_EQ(move({410, 300}), HandOutcome{});
}

TEST_F(HandTest, APenPaintsAndPalmsDoNot) {
  const auto pen = [&](PointerPhase phase, ScreenPoint at) {
    return send({.phase = phase,
                 .kind = PointerKind::pen,
                 .id = 5,
                 .button = PointerButton::left,
                 .at = at,
                 .modifiers = {}});
  };
  expect_acts(pen(PointerPhase::press, {400, 300}), {{Act::begin, {0, 0}}});
  EXPECT_EQ(finger(PointerPhase::press, 7, {600, 300}), HandOutcome{});
  EXPECT_EQ(finger(PointerPhase::move, 7, {700, 300}), HandOutcome{});
  EXPECT_EQ(press({500, 300}), HandOutcome{}) << "nor does the mouse";
  EXPECT_EQ(move({510, 300}), HandOutcome{});
  EXPECT_EQ(mouse(PointerPhase::cancel, {510, 300}), HandOutcome{});
  expect_acts(pen(PointerPhase::move, {410, 300}), {{Act::draw, {1, 0}}});
  EXPECT_EQ(finger(PointerPhase::release, 7, {700, 300}), HandOutcome{});
  expect_acts(pen(PointerPhase::release, {410, 300}), {{Act::end}});
}

TEST_F(HandTest, AFingerPaintsOnceItHasMoved) {
  EXPECT_EQ(finger(PointerPhase::press, 1, {400, 300}), HandOutcome{});
  EXPECT_EQ(hand.over(), (ScreenPoint{400, 300}));
  EXPECT_EQ(finger(PointerPhase::move, 1, {409, 300}), HandOutcome{});
  EXPECT_FALSE(hand.paints());
  expect_acts(finger(PointerPhase::move, 1, {410, 300}),
              {{Act::begin, {0, 0}}, {Act::draw, {1, 0}}});
  EXPECT_EQ(hand.over(), (ScreenPoint{410, 300}));
  expect_acts(finger(PointerPhase::move, 1, {410, 310}), {{Act::draw, {1, -1}}});
  expect_acts(finger(PointerPhase::release, 1, {410, 310}), {{Act::end}});
  EXPECT_EQ(hand.over(), std::nullopt) << "no brush is left where no finger is";
}

TEST_F(HandTest, AFingerPaintsOnceItHasStayed) {
  finger(PointerPhase::press, 1, {400, 300});
  now += milliseconds(249);
  EXPECT_EQ(finger(PointerPhase::move, 1, {401, 300}), HandOutcome{});
  now += milliseconds(1);
  expect_acts(finger(PointerPhase::move, 1, {402, 300}),
              {{Act::begin, {0, 0}}, {Act::draw, {0.2, 0}}});
}

TEST_F(HandTest, AFingerThatWaitedPaintsFromWhereItCameDown) {
  finger(PointerPhase::press, 1, {400, 300});
  EXPECT_EQ(finger(PointerPhase::move, 1, {405, 300}), HandOutcome{});
  now += milliseconds(300);
  expect_acts(finger(PointerPhase::release, 1, {405, 300}),
              {{Act::begin, {0, 0}}, {Act::draw, {0.5, 0}}, {Act::end}});
}

TEST_F(HandTest, ATapIsOneStamp) {
  finger(PointerPhase::press, 1, {400, 300});
  expect_acts(finger(PointerPhase::release, 1, {403, 300}), {{Act::begin, {0, 0}}, {Act::end}});
  EXPECT_FALSE(hand.paints());
}

TEST_F(HandTest, TheFirstOfTwoFingersPaintsNothing) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::move, 1, {304, 300});
  EXPECT_EQ(finger(PointerPhase::press, 2, {500, 300}), HandOutcome{});
  EXPECT_EQ(hand.over(), std::nullopt);
  EXPECT_TRUE(finger(PointerPhase::move, 2, {600, 300}).brush.empty());
  EXPECT_TRUE(finger(PointerPhase::release, 1, {304, 300}).brush.empty());
  EXPECT_TRUE(finger(PointerPhase::release, 2, {600, 300}).brush.empty());
}

TEST_F(HandTest, ASecondFingerEndsAStrokeThatWasBegun) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::move, 1, {350, 300});
  expect_acts(finger(PointerPhase::press, 2, {500, 300}), {{Act::end}});
  EXPECT_FALSE(hand.paints());
}

TEST_F(HandTest, TwoFingersMoveAndZoomTogether) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::press, 2, {500, 300});
  const MapPoint first = under({300, 300}), second = under({500, 300});
  EXPECT_TRUE(finger(PointerPhase::move, 1, {200, 310}).camera_moved);
  EXPECT_TRUE(finger(PointerPhase::move, 2, {600, 310}).camera_moved);
  EXPECT_NEAR(camera.place().zoom, 20, 0.1);
  EXPECT_NEAR(camera.place().yaw, 0, 1e-9) << "not twisted far enough";
  EXPECT_NEAR(under({400, 310}).x, (first.x + second.x) / 2, 0.05);
  EXPECT_NEAR(under({400, 310}).y, 0, 0.05);
}

TEST_F(HandTest, TwoFingersTurnTheMapWithThem) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::press, 2, {500, 300});
  const auto at = [](double angle) {
    return ScreenPoint{300 + 200 * std::cos(angle), 300 + 200 * std::sin(angle)};
  };
  finger(PointerPhase::move, 2, at(0.17));
  EXPECT_EQ(camera.place().yaw, 0);
  finger(PointerPhase::move, 2, at(0.2));
  const MapPoint first = under({300, 300}), second = under(at(0.2));
  finger(PointerPhase::move, 2, at(0.7));  // clockwise
  EXPECT_NEAR(camera.place().yaw, 0.5, 1e-9);
  expect_point(under({300, 300}), first);
  expect_point(under(at(0.7)), second);
}

TEST_F(HandTest, TheFingerThatStaysMovesTheMap) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::press, 2, {500, 300});
  finger(PointerPhase::release, 1, {300, 300});
  const MapPoint held = under({500, 300});
  const HandOutcome out = finger(PointerPhase::move, 2, {550, 300});
  EXPECT_TRUE(out.camera_moved);
  EXPECT_TRUE(out.brush.empty());
  expect_point(under({550, 300}), held);
  EXPECT_EQ(finger(PointerPhase::move, 1, {0, 0}), HandOutcome{});
  finger(PointerPhase::press, 3, {300, 300});
  finger(PointerPhase::move, 3, {50, 300});
  EXPECT_NEAR(camera.place().zoom, 20, 1e-9) << "another finger pinches again";
}

TEST_F(HandTest, AThirdFingerDoesNothing) {
  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::press, 2, {500, 300});
  EXPECT_EQ(finger(PointerPhase::press, 3, {400, 400}), HandOutcome{});
  EXPECT_EQ(finger(PointerPhase::move, 3, {400, 500}), HandOutcome{});
  EXPECT_EQ(finger(PointerPhase::release, 3, {400, 500}), HandOutcome{});
  EXPECT_TRUE(finger(PointerPhase::move, 2, {600, 300}).camera_moved);
}

TEST_F(HandTest, FingersThatMeetDoNotLeap) {
  finger(PointerPhase::press, 1, {400, 300});
  finger(PointerPhase::press, 2, {400, 300});
  finger(PointerPhase::move, 2, {404, 300});
  finger(PointerPhase::move, 2, {412, 300});
  EXPECT_EQ(camera.place().zoom, 10);
  EXPECT_EQ(camera.place().yaw, 0);
  finger(PointerPhase::move, 2, {424, 300});
  EXPECT_NEAR(camera.place().zoom, 20, 1e-9);
}

TEST_F(HandTest, WithTheMoveToolAFingerMovesTheMap) {
  tool = Tool::move;
  finger(PointerPhase::press, 1, {400, 300});
  EXPECT_TRUE(finger(PointerPhase::move, 1, {402, 300}).camera_moved);
  expect_point(under({402, 300}), {0, 0});
}

TEST_F(HandTest, WhatTheSystemTakesAwayIsCancelled) {
  press({400, 300});
  expect_acts(mouse(PointerPhase::cancel, {400, 300}), {{Act::cancel}});
  EXPECT_FALSE(hand.paints());
  EXPECT_EQ(release({400, 300}), HandOutcome{});

  finger(PointerPhase::press, 1, {400, 300});
  EXPECT_EQ(finger(PointerPhase::cancel, 1, {400, 300}), HandOutcome{});
  EXPECT_EQ(finger(PointerPhase::release, 1, {400, 300}), HandOutcome{}) << "no tap";
}

TEST_F(HandTest, CancelLeavesNothingOpen) {
  press({400, 300});
  hand.cancel();
  EXPECT_FALSE(hand.paints());
  EXPECT_EQ(move({450, 300}), HandOutcome{});
  EXPECT_EQ(release({450, 300}), HandOutcome{});

  finger(PointerPhase::press, 1, {300, 300});
  finger(PointerPhase::press, 2, {500, 300});
  hand.cancel();
  EXPECT_EQ(finger(PointerPhase::move, 2, {600, 300}), HandOutcome{});
  EXPECT_EQ(finger(PointerPhase::release, 2, {600, 300}), HandOutcome{});
}

TEST_F(HandTest, PlacesThatAreNotFiniteAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(press({nan, 300}), HandOutcome{});
  press({400, 300});
  EXPECT_EQ(move({400, nan}), HandOutcome{});
  expect_acts(release({nan, nan}), {{Act::end}});
  EXPECT_EQ(wheel(nan, 1), HandOutcome{});
  EXPECT_EQ(wheel(1, nan, kShift), HandOutcome{});
}

TEST_F(HandTest, TheWheelZoomsToThePointer) {
  const MapPoint held = under({600, 100});
  EXPECT_TRUE(wheel(0, -100, {}, {600, 100}).camera_moved);
  EXPECT_NEAR(camera.place().zoom, 10 * std::exp(0.2), 1e-9);
  expect_point(under({600, 100}), held);
  wheel(0, 60);
  wheel(0, 40);
  EXPECT_NEAR(camera.place().zoom, 10, 1e-9) << "as much in steps as at once";
  wheel(0, 1e300);
  EXPECT_NEAR(camera.place().zoom, 10 * std::exp(-2), 1e-9);
}

TEST_F(HandTest, APinchOnATrackpadZoomsAsFingersDo) {
  wheel(0, -20, kControl);
  EXPECT_NEAR(camera.place().zoom, 10 * std::exp(0.2), 1e-9);
  wheel(0, 120, kControl);
  EXPECT_NEAR(camera.place().zoom, 10 * std::exp(-0.05), 1e-9) << "a notch is no leap";
}

TEST_F(HandTest, ScrollingSidewaysMovesTheMap) {
  EXPECT_TRUE(wheel(30, 10).camera_moved);
  EXPECT_EQ(camera.place().zoom, 10);
  expect_point(camera.place().target, {3, 0});
}

TEST_F(HandTest, TheWheelWithShiftIsTheRadius) {
  EXPECT_EQ(wheel(0, -120, kShift), (HandOutcome{.radius_steps = 1}));
  EXPECT_EQ(wheel(0, 48, kShift), (HandOutcome{.radius_steps = -1}));
  EXPECT_EQ(wheel(-100, 0, kShift).radius_steps, 1) << "as some browsers turn it";
  EXPECT_EQ(camera.place().zoom, 10);
}

TEST_F(HandTest, FineScrollingAddsUpToStepsOfTheRadius) {
  int steps = 0;
  for (int i = 0; i < 30; ++i) steps += wheel(0, -3.5, kShift).radius_steps;
  EXPECT_EQ(steps, 3);
  wheel(0, -19, kShift);
  EXPECT_EQ(wheel(0, 60, kShift).radius_steps, -1);
  wheel(0, -29, kShift);
  EXPECT_EQ(wheel(0, 2, kShift).radius_steps, 0) << "the other way it begins anew";
  EXPECT_EQ(wheel(0, 27.5, kShift).radius_steps, 0);
  EXPECT_EQ(wheel(0, 0.5, kShift).radius_steps, -1);
}

// Whatever happens: strokes begin before they are drawn and end once, nothing of the camera is
// moved while one paints, and after a cancel nothing is open.
RC_GTEST_PROP(Hand, KeepsStrokesInOrder, ()) {
  scene::Camera camera;
  camera.resize({800, 600});
  Hand hand;
  Hand::Time now{};
  bool open = false;
  const int steps = *rc::gen::inRange(0, 120);
  for (int i = 0; i < steps; ++i) {
    now += milliseconds(*rc::gen::element(1, 300));
    const auto kind = *rc::gen::element(PointerKind::mouse, PointerKind::pen, PointerKind::touch);
    const std::int32_t id = kind == PointerKind::mouse ? 1
                            : kind == PointerKind::pen ? 2
                                                       : *rc::gen::inRange(3, 6);
    const PointerEvent event{
        .phase =
            *rc::gen::element(PointerPhase::press, PointerPhase::move, PointerPhase::move,
                              PointerPhase::release, PointerPhase::cancel, PointerPhase::leave),
        .kind = kind,
        .id = id,
        .button = *rc::gen::element(PointerButton::left, PointerButton::left, PointerButton::middle,
                                    PointerButton::right),
        .at = {*rc::gen::inRange(0, 800) + 0.5, *rc::gen::inRange(0, 600) + 0.5},
        .modifiers = {}};
    const bool painted = open;
    const auto out = hand.pointer(
        event, {.camera = camera, .tool = *rc::gen::element(Tool::paint, Tool::paint, Tool::move)},
        now);
    for (const BrushAct& act : out.brush) {
      RC_ASSERT(open == (act.kind != Act::begin));
      open = act.kind == Act::begin || act.kind == Act::draw;
    }
    RC_ASSERT(hand.paints() == open);
    RC_ASSERT(!(painted && open && out.camera_moved));
    if (*rc::gen::inRange(0, 40) == 0) {
      hand.cancel();
      open = false;
    }
    RC_ASSERT(hand.paints() == open);
  }
}

}  // namespace
}  // namespace earthwork::viewer
