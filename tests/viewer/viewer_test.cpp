// What a person sees and does at a map: camera, brush, others, layers, panels, keys.
#include "client/viewer/viewer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "client/link/unanswered.hpp"
#include "client/viewer/shortcuts.hpp"
#include "protocol/frame.hpp"
#include "tests/viewer/played_server.hpp"

namespace earthwork::viewer {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using protocol::Code;
using protocol::MapPoint;
using protocol::MapRect;
using Kind = NoticesPart::Notice::Kind;

scene::Camera::Place place(PlayedServer& server) {
  server.frame();
  return server.drawn.picture.camera.place();
}

MapRect rect_of(const json& view) {
  const auto& r = view["rect"];
  return {r[0], r[1], r[2], r[3]};
}

bool holds(const MapRect& outer, const MapRect& inner) {
  return outer.x0 <= inner.x0 && outer.y0 <= inner.y0 && inner.x1 <= outer.x1 &&
         inner.y1 <= outer.y1;
}

void run(PlayedServer& server, const PanelCommand& command) {
  const auto done = server.viewer->command(command, server.now);
  EXPECT_TRUE(done) << (done ? "" : done.error().detail);
}

protocol::Failure refused(PlayedServer& server, const PanelCommand& command) {
  const auto done = server.viewer->command(command, server.now);
  EXPECT_FALSE(done);
  return done ? protocol::Failure{} : done.error();
}

void point(PlayedServer& server, const std::string& session, std::optional<MapPoint> at,
           std::optional<protocol::Brush> brush, MapRect view = {0, 0, 64, 64}) {
  server.say(protocol::Presence{
      .all = false,
      .users = {},
      .left = {},
      .cursors = {{.session = session, .at = at, .brush = brush, .view = view}}});
}

void arrive(PlayedServer& server, const std::string& session, const std::string& name) {
  server.say(
      protocol::Presence{.all = false, .users = {user(session, name)}, .left = {}, .cursors = {}});
}

/// A circle of radius 5 on layer 1.
protocol::Brush stone_in_hand() {
  protocol::Brush brush;
  brush.radius = 5;
  brush.layer = 1;
  return brush;
}

/// A change of the brush in hand.
template <class Member, class Value>
SetBrush with(Member SetBrush::*what, Value value) {
  SetBrush set;
  set.*what = value;
  return set;
}

std::vector<NoticesPart::Notice> notices(PlayedServer& server) {
  const auto part = server.viewer->panels(server.now).notices;
  return part ? part->notices : std::vector<NoticesPart::Notice>{};
}

/// Joined, zoomed so that a voxel has 10 pixels, 0 in the middle of the screen.
struct AtZero : PlayedServer {
  explicit AtZero(const protocol::MapSettings& settings = bounded()) {
    join(settings);
    run(*this, MoveCamera{.action = MoveCamera::Action::go,
                          .place = {.target = {0, 0}, .zoom = 10, .yaw = 0, .tilt = 0}});
    static_cast<void>(viewer->panels(now));
    frame();
  }
};

TEST(Viewer, ShowsAllOfABoundedMap) {
  PlayedServer server;
  server.join(bounded());
  server.frame();
  EXPECT_TRUE(holds(server.drawn.picture.camera.seen(0, 0), {-1024, -1024, 1024, 1024}));
  EXPECT_TRUE(holds(rect_of(server.last("view")), {-1023, -1023, 1023, 1023}));
  ASSERT_EQ(server.drawn.picture.outlines.size(), 1u);  // where it ends
  EXPECT_EQ(server.drawn.picture.outlines[0].points[2], (MapPoint{1024, 1024}));
}

TEST(Viewer, FindsWhatThereIsOnAMapWithoutBounds) {
  PlayedServer server;
  server.join();
  EXPECT_TRUE(holds(rect_of(server.last("view")), {-256, -256, 256, 256}));
  server.show({{0, 3, 1, 0}, {0, 4, 1, 0}});
  server.catch_up();
  EXPECT_NEAR(place(server).target.x, 128, 1e-6);
  EXPECT_NEAR(place(server).target.y, 48, 1e-6);
  EXPECT_TRUE(holds(server.drawn.picture.camera.seen(0, 0), {96, 32, 160, 64}));
}

TEST(Viewer, LooksOnWhileThereIsMoreAndNotAfterAMoveOfOnesOwn) {
  PlayedServer server;
  server.join();
  server.show({{0, -13, 0, 0}, {0, 12, 0, 0}});
  server.catch_up();
  server.pass(1s);
  EXPECT_EQ(server.count("view"), 2u);
  server.show({{0, 14, 0, 0}});
  server.catch_up();
  EXPECT_NEAR(place(server).target.x, (-13 * 32 + 15 * 32) / 2, 1e-6);
  server.key("ArrowUp");
  const auto own = place(server);
  server.show({{0, 15, 0, 0}});
  server.catch_up();
  EXPECT_EQ(place(server), own);
}

TEST(Viewer, LooksNoFurtherOnceAllIsSeen) {
  PlayedServer server;
  server.join();
  server.show({{0, 3, 1, 0}});
  server.catch_up();
  const auto found = place(server);
  server.show({{0, 6, 1, 0}});  // painted since
  server.catch_up();
  EXPECT_EQ(place(server), found);
}

TEST(Viewer, GoesToThePlaceThatALinkNames) {
  ViewerOptions options = PlayedServer::default_options();
  options.place = {.target = {5000, -20}, .zoom = 20, .yaw = 0.5, .tilt = 0.25};
  PlayedServer server(options);
  server.join();
  EXPECT_EQ(place(server), *options.place);
  EXPECT_TRUE(holds(rect_of(server.last("view")), {4985, -35, 5015, -5}));
  server.show({{0, 0, 0, 0}});
  server.catch_up();
  EXPECT_EQ(place(server), *options.place);
}

TEST(Viewer, AsksForWhatComesIntoView) {
  AtZero server;
  server.pass(1s);
  const std::size_t views = server.count("view");
  server.key("ArrowRight");
  EXPECT_EQ(server.count("view"), views);
  for (int i = 0; i < 30; ++i) server.key("ArrowRight");
  server.pass(1s);
  EXPECT_GT(server.count("view"), views);
  EXPECT_LE(server.count("view"), views + 5);
  EXPECT_TRUE(holds(rect_of(server.last("view")), server.drawn.picture.camera.seen(0, 0)) ||
              server.last("view")["rect"][0] > 0);
}

TEST(Viewer, AsksForNothingWhileThereIsNoConnection) {
  AtZero server;
  server.cut();
  const std::size_t sent = server.shell.sent.size();
  for (int i = 0; i < 60; ++i) server.key("ArrowRight");
  server.hover(100, 100);
  EXPECT_EQ(server.shell.sent.size(), sent);
  server.pass(250ms);
  server.join(bounded());
  server.frame();
  EXPECT_TRUE(holds(rect_of(server.last("view")), server.drawn.picture.camera.seen(0, 0)));
}

TEST(Viewer, IsDrawnAgainOnlyWhenSomethingVisibleChanged) {
  AtZero server;
  arrive(server, kAnn, "Ann");
  server.pass(2s);
  server.draw_if_asked();
  const auto redrawn = [&](const auto& what) {
    what();
    return server.draw_if_asked();
  };
  EXPECT_FALSE(redrawn([&] { server.say(protocol::Done{.id = 9}); }));
  EXPECT_FALSE(redrawn([&] { arrive(server, kBob, "Bob"); }));
  EXPECT_FALSE(redrawn([&] { server.pass(2s); }));
  EXPECT_FALSE(redrawn([&] { run(server, UseTool{Tool::paint}); }));
  EXPECT_TRUE(redrawn([&] { server.show({{0, 0, 0, 0}}); }));
  EXPECT_TRUE(redrawn([&] { server.hover(10, 10); }));
  EXPECT_FALSE(redrawn([&] { server.hover(10, 10); }));
  EXPECT_TRUE(redrawn([&] { server.key("]"); }));
  EXPECT_TRUE(redrawn([&] { point(server, kAnn, MapPoint{1, 1}, std::nullopt); }));
  EXPECT_TRUE(redrawn([&] { server.key("+"); }));
  EXPECT_TRUE(redrawn([&] { server.viewer->resize({900, 600}, 2, server.now); }));
  EXPECT_TRUE(redrawn([&] { run(server, ShowLayer{.layer = 0, .visible = false}); }));
  EXPECT_TRUE(redrawn([&] { server.cut(); }));  // the others' cursors are gone
}

TEST(Viewer, HandsOutTheChunksThatChanged) {
  PlayedServer server;
  server.join(bounded());
  server.show({{0, 0, 0, 0}, {0, 1, 0, 0}});
  server.frame();
  EXPECT_TRUE(server.drawn.all);
  EXPECT_EQ(server.drawn.changed.size(), 2u);
  server.show({{0, 1, 0, 0}}, 2);
  server.frame();
  EXPECT_FALSE(server.drawn.all);
  EXPECT_EQ(server.drawn.changed, (std::vector<protocol::ChunkKey>{{0, 1, 0, 0}}));
  server.frame();
  EXPECT_TRUE(server.drawn.changed.empty());
  run(server, OpenMap{"other"});
  server.frame();
  EXPECT_TRUE(server.drawn.all);
  EXPECT_TRUE(server.drawn.changed.empty());
}

TEST(Viewer, OnesOwnBrushFollowsThePointerAtOnce) {
  AtZero server(layered(2));
  server.hover(430, 280);
  server.frame();
  ASSERT_EQ(server.drawn.picture.outlines.size(), 2u);  // shade and line
  const auto& edge = server.drawn.picture.outlines.back();
  for (const MapPoint& at : edge.points)
    EXPECT_NEAR(std::hypot(at.x - 3, at.y - 2), 3, 1e-3);  // the default radius
  const Color filling = edge.color;
  server.key("e");
  server.key("2");
  server.frame();
  EXPECT_EQ(server.drawn.picture.outlines.back().points.size(), 4u);
  EXPECT_NE(server.drawn.picture.outlines.back().color, filling);
  run(server, with(&SetBrush::radius_voxels, 0.0));
  run(server, with(&SetBrush::layer, 1u));
  server.frame();
  EXPECT_FALSE(server.drawn.picture.outlines.back().closed);  // a cross
  EXPECT_EQ(server.drawn.picture.dots_layer, 1u);
  server.key("v");
  server.frame();
  EXPECT_TRUE(server.drawn.picture.outlines.empty());
}

TEST(Viewer, ShowsWhereOthersPointAndWhatTheyHold) {
  AtZero server(layered(2));
  arrive(server, kAnn, "Ann");
  point(server, kAnn, MapPoint{10, 0}, stone_in_hand());
  point(server, kMe, MapPoint{0, 0}, protocol::Brush{});  // one's own comes back too
  server.frame();
  ASSERT_EQ(server.drawn.picture.outlines.size(), 1u);
  EXPECT_EQ(server.drawn.picture.outlines[0].color, color_of("#aabbcc"));
  EXPECT_GE(server.drawn.picture.outlines[0].points.size(), 16u);
  const auto labels = server.viewer->labels();
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_EQ(labels[0].text, "Ann");
  EXPECT_NEAR(labels[0].at.x, 500, 1e-6);
  EXPECT_NEAR(labels[0].at.y, 300, 1e-6);
  point(server, kAnn, MapPoint{10, 0}, std::nullopt);
  server.frame();
  EXPECT_FALSE(server.drawn.picture.outlines.at(0).closed);
  point(server, kAnn, MapPoint{1000, 0}, std::nullopt);
  EXPECT_TRUE(server.viewer->labels().empty());  // outside the screen
}

TEST(Viewer, TellsOthersWhereItPointsAndWhatItSees) {
  AtZero server;
  server.pass(1s);
  server.hover(500, 300);
  json cursor = server.last("cursor");
  EXPECT_EQ(cursor["x"], 10);
  EXPECT_EQ(cursor["brush"]["radius"], 3);
  EXPECT_EQ(cursor["view"].size(), 4u);
  const std::size_t said = server.count("cursor");
  for (int i = 0; i < 100; ++i) {
    server.pass(10ms);
    server.hover(400 + i, 300);
  }
  EXPECT_GE(server.count("cursor"), said + 18);
  EXPECT_LE(server.count("cursor"), said + 21);
  server.leave();
  server.pass(50ms);
  EXPECT_EQ(server.last("cursor")["hidden"], true);
  EXPECT_TRUE(server.last("cursor").contains("view"));
}

TEST(Viewer, PaintsAsTheDragGoes) {
  AtZero server;
  server.press(400, 300);
  ASSERT_EQ(server.count("edit"), 1u);  // at once
  EXPECT_EQ(server.last("edit")["radius"], 3);
  server.drag(500, 300);
  EXPECT_EQ(server.count("edit"), 1u);
  server.frame();
  ASSERT_EQ(server.count("edit"), 2u);
  EXPECT_EQ(server.last("edit")["stroke"], server.all("edit")[0]["stroke"]);
  server.drag(600, 300);
  server.release(600, 300);
  ASSERT_EQ(server.count("edit"), 3u);
  EXPECT_NEAR(server.last("edit")["path"].back()[0], 20, 1e-6);
  const json stroke = server.last("edit")["stroke"];
  server.drag(700, 300);
  server.frame();
  EXPECT_EQ(server.count("edit"), 3u);
  server.press(400, 300);
  EXPECT_GT(server.last("edit")["stroke"], stroke);
}

TEST(Viewer, ADragWithSpaceHeldMovesTheMapAndPaintsNothing) {
  AtZero server;
  server.viewer->hold_space(true);
  server.press(400, 300);
  server.drag(500, 300);
  server.release(500, 300);
  EXPECT_EQ(server.count("edit"), 0u);
  EXPECT_NEAR(place(server).target.x, -10, 1e-6);
  server.viewer->hold_space(false);
  server.press(400, 300);
  EXPECT_EQ(server.count("edit"), 1u);
}

TEST(Viewer, EscapeEndsAStroke) {
  AtZero server;
  server.press(400, 300);
  server.drag(500, 300);
  server.key("Escape");
  server.drag(600, 300);
  server.release(600, 300);
  server.frame();
  EXPECT_EQ(server.count("edit"), 1u);
}

TEST(Viewer, PaintsOnWhileTheServerIsAway) {
  AtZero server;
  server.cut();
  server.press(400, 300);
  server.drag(500, 300);
  server.release(500, 300);
  EXPECT_EQ(server.count("edit"), 0u);
  server.pass(250ms);
  server.join(bounded());
  EXPECT_EQ(server.count("edit"), 2u);
}

TEST(Viewer, SaysWhenNoMoreCanBeKept) {
  AtZero server;
  server.cut();
  for (std::size_t i = 0; i < link::kMaxUnansweredEdits + 3; ++i) {
    server.press(400, 300);
    server.release(400, 300);
  }
  const auto told = notices(server);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, Kind::lost);
  EXPECT_NE(told[0].words.find("4096"), std::string::npos) << told[0].words;
  server.await_connect();
  server.join(bounded());
  EXPECT_EQ(server.count("edit"), link::kMaxUnansweredEdits);
}

TEST(Viewer, TellsWhatWasRefusedWhereItHappened) {
  AtZero server;
  server.press(500, 300);
  server.release(500, 300);
  server.draw_if_asked();
  server.say(protocol::Rejected{.id = 1, .failure = {Code::disk_full, "the disk is full", {}}});
  const auto told = notices(server);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].kind, Kind::rejected);
  EXPECT_EQ(told[0].words, "Not painted: the disk is full");
  EXPECT_EQ(told[0].at, (MapPoint{10, 0}));
  EXPECT_TRUE(server.draw_if_asked());
  ASSERT_EQ(server.viewer->labels().size(), 1u);
  EXPECT_EQ(server.viewer->labels()[0].kind, Label::Kind::notice);
  server.pass(7s);
  EXPECT_TRUE(server.draw_if_asked());
  EXPECT_TRUE(server.viewer->labels().empty());
}

TEST(Viewer, FollowsSomebodyUntilItMovesItself) {
  AtZero server;
  arrive(server, kAnn, "Ann");
  point(server, kAnn, std::nullopt, std::nullopt, {100, 100, 164, 140});
  run(server, Follow{kAnn});
  EXPECT_NEAR(place(server).target.x, 132, 1e-6);
  EXPECT_TRUE(server.viewer->panels(server.now).people->people[1].followed);
  point(server, kAnn, std::nullopt, std::nullopt, {200, 100, 264, 140});
  EXPECT_NEAR(place(server).target.x, 232, 1e-6);
  server.key("+");
  EXPECT_FALSE(server.viewer->panels(server.now).people->people[1].followed);
  const auto own = place(server);
  point(server, kAnn, std::nullopt, std::nullopt, {300, 100, 364, 140});
  EXPECT_EQ(place(server), own);
  run(server, Follow{kAnn});
  EXPECT_TRUE(server.viewer->panels(server.now).people->people[1].followed);
  server.key("Escape");
  EXPECT_FALSE(server.viewer->panels(server.now).people->people[1].followed);
  EXPECT_EQ(refused(server, Follow{kBob}).field, "session");
  EXPECT_EQ(refused(server, Follow{kMe}).field, "session");
}

TEST(Viewer, TellsTheViewOfWhomItFollows) {
  AtZero server;
  arrive(server, kAnn, "Ann");
  point(server, kAnn, std::nullopt, std::nullopt, {100, 100, 164, 140});
  run(server, Follow{kAnn});
  server.pass(1s);
  EXPECT_EQ(server.last("cursor")["view"], json::parse("[100.0,100.0,164.0,140.0]"));
}

TEST(Viewer, FollowsNobodyWhoHasLeft) {
  AtZero server;
  arrive(server, kAnn, "Ann");
  run(server, Follow{kAnn});
  server.say(protocol::Presence{.all = false, .users = {}, .left = {kAnn}, .cursors = {}});
  arrive(server, kAnn, "Ann");
  EXPECT_FALSE(server.viewer->panels(server.now).people->people[1].followed);
}

TEST(Viewer, LayersAreAsTheServerSaysAndShownAsOneLikes) {
  AtZero server(layered(3));
  server.show({{0, 0, 0, 0}, {1, 0, 0, 0}});
  run(server, with(&SetBrush::layer, 2u));
  EXPECT_EQ(refused(server, with(&SetBrush::layer, 3u)).detail, "layer: 3 of a map with 3 layers");
  EXPECT_EQ(refused(server, ShowLayer{.layer = 3}).field, "layer");
  run(server, ShowLayer{.layer = 1, .visible = false});
  server.frame();
  EXPECT_TRUE(server.drawn.picture.hidden.test(1));
  EXPECT_EQ(server.viewer->panels(server.now).map->hidden, std::vector<std::uint32_t>{1});

  protocol::MapSettings fewer = layered(2);
  fewer.layers[1].top = 4;
  fewer.layers[1].name = "stone";
  server.say(protocol::SettingsChanged{.seq = 5, .settings = fewer});
  server.frame();
  EXPECT_EQ(server.drawn.picture.settings, fewer);
  EXPECT_EQ(server.drawn.changed, (std::vector<protocol::ChunkKey>{{1, 0, 0, 0}}));  // its walls
  const auto panels = server.viewer->panels(server.now);
  EXPECT_EQ(panels.map->settings.layers[1].name, "stone");
  EXPECT_EQ(panels.brush->brush.layer, 1u);
}

TEST(Viewer, AsksTheServerToChangeLayers) {
  AtZero server(layered(2));
  run(server, ChangeLayer{{.layer = 1, .name = "sea", .color = {}, .wall = {}}});
  EXPECT_EQ(server.last("layer"), json::parse(R"({"type":"layer","id":1,"layer":1,"name":"sea"})"));
  EXPECT_EQ(refused(server, ChangeLayer{{.layer = 2, .name = "x", .color = {}, .wall = {}}}).field,
            "layer");
  server.say(protocol::Rejected{.id = 1, .failure = {Code::read_only, "it is read-only", {}}});
  const auto told = notices(server);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].words, "The layer was not changed: it is read-only");
  EXPECT_FALSE(told[0].at);
}

TEST(Viewer, TalksAndTellsWhatWasNotSaid) {
  AtZero server;
  run(server, Say{"Grüße"});
  EXPECT_EQ(server.last("chat")["text"], "Grüße");
  server.say(protocol::ChatLines{
      {{.n = 1, .time_ms = 5, .session = kMe, .name = "Me", .color = "#aabbcc", .text = "Grüße"}}});
  EXPECT_EQ(server.viewer->panels(server.now).chat->lines.at(0).text, "Grüße");
  const protocol::MessageId id = server.last("chat")["id"];
  server.say(protocol::Rejected{.id = id, .failure = {Code::too_fast, "text: 8 in 10 s", "text"}});
  EXPECT_EQ(notices(server).at(0).words, "Not said: text: 8 in 10 s");
  EXPECT_EQ(server.viewer->panels(server.now).chat, std::nullopt);
  server.catch_up();
  EXPECT_TRUE(server.viewer->panels(server.now).chat->known);
  server.cut();
  EXPECT_EQ(refused(server, Say{"hello?"}).field, "text");
}

TEST(Viewer, EveryKeyOfTheTableDoesSomething) {
  AtZero server(layered(3));
  for (const auto& shortcut : shortcuts().shortcuts)
    for (const std::string& key : shortcut.keys) EXPECT_TRUE(server.key(key)) << key;
  EXPECT_FALSE(server.key("?"));
  EXPECT_FALSE(server.viewer->key({.key = "f", .modifiers = {.control = true}}, server.now));
  EXPECT_FALSE(server.viewer->key({.key = "f", .modifiers = {.alt = true}}, server.now));
}

TEST(Viewer, PaintsByKeysAlone) {
  AtZero server(layered(3));
  for (const char* key : {"E", "2", "]", "}", "g", ".", ".", ".", ","}) server.key(key);
  const auto brush = server.viewer->panels(server.now).brush->brush;
  EXPECT_FALSE(brush.fill);
  EXPECT_EQ(brush.stencil, protocol::StencilShape::square);
  EXPECT_EQ(brush.radius_voxels, 9);
  EXPECT_EQ(brush.snap, scene::Snap::centres);
  EXPECT_EQ(brush.layer, 1u);
  server.key("Enter");
  const json edit = server.last("edit");
  EXPECT_EQ(edit["path"], json::parse("[[0.5,0.5]]"));
  EXPECT_EQ(edit["layer"], 1);
  for (int i = 0; i < 30; ++i) server.key("{");
  EXPECT_EQ(server.viewer->panels(server.now).brush->brush.radius_voxels, 0);
  for (int i = 0; i < 30; ++i) server.key("}");
  EXPECT_EQ(server.viewer->panels(server.now).brush->brush.radius_voxels, 50);
}

TEST(Viewer, HandsOutPartsOnlyWhenTheyChanged) {
  PlayedServer server;
  const auto first = server.viewer->panels(server.now);
  EXPECT_TRUE(first.connection && first.brush && first.shortcuts && first.status && first.camera);
  EXPECT_FALSE(first.map);
  server.join();
  server.pass(1s);
  const auto joined = server.viewer->panels(server.now);
  EXPECT_TRUE(joined.connection && joined.map && joined.people && joined.status);
  EXPECT_FALSE(joined.shortcuts || joined.brush || joined.notices);
  EXPECT_EQ(write(server.viewer->panels(server.now)), "{}");
}

TEST(Viewer, StatusAndCameraComeAtMostFourTimesASecond) {
  AtZero server;
  server.pass(1s);
  int handed = 0;
  for (int i = 0; i < 100; ++i) {
    server.pass(10ms);
    server.key("ArrowRight");
    const auto panels = server.viewer->panels(server.now);
    if (panels.camera) ++handed;
  }
  EXPECT_GE(handed, 3);
  EXPECT_LE(handed, 5);
  server.pass(250ms);
  EXPECT_EQ(server.viewer->panels(server.now).camera.has_value() || handed == 5, true);
}

TEST(Viewer, MeasuresWhatIsDrawn) {
  AtZero server;
  server.pass(1s);
  server.show({{0, 0, 0, 0}}, 3);
  for (int i = 0; i < 5; ++i) server.viewer->drawn(server.now, server.now, 2);
  const auto status = server.viewer->panels(server.now).status;
  ASSERT_TRUE(status);
  EXPECT_EQ(status->fps, 5);
  EXPECT_EQ(status->triangles, 2u);
  EXPECT_EQ(status->chunks, 1u);
  EXPECT_GT(status->bytes, 0u);
  EXPECT_FALSE(status->caught_up);
  server.catch_up(4);
  server.pass(1s);
  const auto still = server.viewer->panels(server.now).status;
  ASSERT_TRUE(still);
  EXPECT_EQ(still->fps, 0);
  EXPECT_TRUE(still->caught_up);
  EXPECT_EQ(still->seq, 4u);
}

TEST(Viewer, PanelsAreWrittenAsThePageReadsThem) {
  PanelChanges changes;
  changes.connection = {.state = ConnectionPart::State::lost,
                        .words = "Gone.",
                        .retry_ms = 250,
                        .key = kKey,
                        .session = kMe};
  changes.brush.emplace();
  changes.notices = {{{.n = 1, .kind = Kind::lost, .words = "Lost.", .at = MapPoint{1, 2}}}};
  changes.camera = {{.target = {1, 2}, .zoom = 3, .yaw = 4, .tilt = 5}};
  const json written = json::parse(write(changes));
  EXPECT_EQ(written.size(), 4u);
  EXPECT_EQ(written["connection"]["state"], "lost");
  EXPECT_EQ(written["connection"]["retry_ms"], 250);
  EXPECT_EQ(written["brush"], json::parse(R"({"tool":"paint","stencil":"circle","fill":true,
                                              "radius":3.0,"layer":0,"snap":"none"})"));
  EXPECT_EQ(written["notices"]["notices"][0],
            json::parse(R"({"n":1,"kind":"lost","words":"Lost.","x":1.0,"y":2.0})"));
  EXPECT_EQ(written["camera"], json::parse(R"({"x":1.0,"y":2.0,"zoom":3.0,"yaw":4.0,"tilt":5.0})"));
  const json labels = json::parse(write(std::vector<Label>{
      {.kind = Label::Kind::notice, .text = "a", .color = "#ffffff", .at = {1, 2}}}));
  EXPECT_EQ(labels,
            json::parse(R"([{"kind":"notice","text":"a","color":"#ffffff","x":1.0,"y":2.0}])"));
}

}  // namespace
}  // namespace earthwork::viewer
