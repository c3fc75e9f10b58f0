#include "server/app/demo.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "server/room/viewer.hpp"

namespace earthwork::app {
namespace {

using protocol::Edit;
using protocol::MapPoint;
using protocol::StencilShape;

// Layers, bottom up.
constexpr std::uint32_t kMeadow = 0, kStone = 1;
constexpr bool kFill = true, kEmpty = false;

Edit stamp(std::uint32_t layer, StencilShape shape, bool fill, double radius, MapPoint at) {
  return {
      .layer = layer, .stencil = shape, .fill = fill, .radius = radius, .path = {at}, .stroke = {}};
}
Edit disc(std::uint32_t layer, bool fill, double radius, MapPoint at) {
  return stamp(layer, StencilShape::circle, fill, radius, at);
}
Edit square(std::uint32_t layer, bool fill, double radius, MapPoint at) {
  return stamp(layer, StencilShape::square, fill, radius, at);
}

/// A brook: a path of small discs along a sine.
Edit brook(double x0, double x1, double y) {
  Edit edit{
      .layer = kMeadow, .fill = kEmpty, .radius = 1.6, .path = {}, .is_path = true, .stroke = {}};
  for (double x = x0; x <= x1; x += 0.75) edit.path.push_back({x, y + 3.5 * std::sin(x / 7)});
  return edit;
}

/// Discs on a circle around `centre`.
void ring(std::vector<Edit>& edits, Edit one, MapPoint centre, double distance, int count) {
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count;
    one.path = {{centre.x + distance * std::cos(angle), centre.y + distance * std::sin(angle)}};
    edits.push_back(one);
  }
}

void island(std::vector<Edit>& edits) {
  edits.push_back(disc(kMeadow, kFill, 40, {0, 0}));
  edits.push_back(disc(kMeadow, kFill, 24, {38, 16}));
  edits.push_back(disc(kMeadow, kFill, 20, {-36, -18}));
  edits.push_back(disc(kMeadow, kEmpty, 17, {10, -42}));  // a bay
  edits.push_back(disc(kMeadow, kEmpty, 9, {-22, 40}));   // and a smaller one
  edits.push_back(disc(kMeadow, kFill, 6, {12, -46}));    // with an islet
  edits.push_back(brook(-60, 62, -12));
  ring(edits, disc(kMeadow, kEmpty, 2.5, {}), {36, 20}, 10, 7);  // a garden of ponds
  edits.push_back(disc(kMeadow, kEmpty, 4.5, {36, 20}));
}

void castle(std::vector<Edit>& edits) {
  const MapPoint at{-4, 12};
  edits.push_back(square(kStone, kFill, 14, at));
  edits.push_back(square(kStone, kEmpty, 11, at));
  for (const double x : {-14.0, 14.0})
    for (const double y : {-14.0, 14.0})
      edits.push_back(disc(kStone, kFill, 4, {at.x + x, at.y + y}));
  edits.push_back(square(kStone, kEmpty, 2.5, {at.x, at.y - 13}));  // the gate
  edits.push_back(square(kStone, kFill, 5, at));                    // the keep,
  edits.push_back(disc(kStone, kEmpty, 4, {at.x + 6, at.y + 6}));   // a bite taken out of it
}

void stones(std::vector<Edit>& edits) {
  ring(edits, square(kStone, kFill, 1.25, {}), {-38, -18}, 9, 9);
  edits.push_back(disc(kStone, kFill, 3, {-38, -18}));
  for (const double x : {18.0, 26.0, 34.0}) edits.push_back(square(kStone, kFill, 1.5, {x, -2}));
}

/// Paints and does not look.
class Painter final : public room::Viewer {
  void answered(std::vector<room::Reply>) override {}
  void deliver(room::Parcel) override {}
  void tell(room::Talk) override {}
  void settings(room::SharedText) override {}
  void end(protocol::Bye) override {}
};

void paint(room::Room& room) {
  auto entrance = room.join(std::make_shared<Painter>(),
                            {"0000000000000000", "demo", "#8a9a5b", "0000000000000000"});
  if (!entrance) return;
  protocol::MessageId id = 0;
  for (Edit& edit : demo_edits()) {
    [[maybe_unused]] const auto taken =
        room.submit(entrance->viewer, {.id = ++id, .author = 0, .action = std::move(edit)});
  }
  room.leave(entrance->viewer);
}

}  // namespace

protocol::MapSettings demo_settings() {
  protocol::MapSettings settings;
  settings.layers = {{.name = "meadow", .color = "#8a9a5b", .bottom = -4, .top = 0},
                     {.name = "stone", .color = "#9c8f80", .bottom = 0, .top = 5}};
  return settings;
}

std::vector<Edit> demo_edits() {
  std::vector<Edit> edits;
  island(edits);
  castle(edits);
  stones(edits);
  return edits;
}

void add_demo(room::Atlas& atlas, std::function<void(protocol::Result<void>)> done) {
  const auto stored = [done](bool kept) {
    if (kept) return done({});
    done(protocol::fail(protocol::Code::storage_failed, "the map demo could not be stored"));
  };
  auto made = [done, stored](const protocol::Result<std::shared_ptr<room::Room>>& room) {
    if (!room && room.error().code == protocol::Code::map_exists) return done({});
    if (!room) return done(tl::unexpected(room.error()));
    (*room)->strand().post([live = *room, stored] {
      paint(*live);
      // Behind the turn that applies it all.
      live->strand().post([live, stored] { live->once_durable(stored); });
    });
  };
  atlas.create("demo", demo_settings(), std::move(made));
}

}  // namespace earthwork::app
