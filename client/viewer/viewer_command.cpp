// What panels and keys ask a viewer to do.
#include <algorithm>
#include <utility>

#include "client/viewer/viewer_state.hpp"
#include "protocol/layer_change.hpp"

namespace earthwork::viewer {

using protocol::Code;
using Action = MoveCamera::Action;
using Done = protocol::Result<void>;

Done Viewer::State::run(const UseTool& use) {
  held.tool = use.tool;
  return {};
}

Done Viewer::State::check_layer(std::uint32_t layer) const {
  const std::size_t count = settings ? settings->layers.size() : 0;
  if (layer < count) return {};
  return protocol::fail(
      Code::out_of_range,
      "layer: " + std::to_string(layer) + " of a map with " + std::to_string(count) + " layers",
      "layer");
}

Done Viewer::State::run(const SetBrush& set) {
  if (set.layer) {
    if (auto there = check_layer(*set.layer); !there) return there;
  }
  scene::BrushSettings& brush = held.brush;
  brush.stencil = set.stencil.value_or(brush.stencil);
  brush.fill = set.fill.value_or(brush.fill);
  brush.layer = set.layer.value_or(brush.layer);
  brush.snap = set.snap.value_or(brush.snap);
  brush.radius_voxels =
      std::clamp(set.radius_voxels.value_or(brush.radius_voxels), 0.0, scene::kMaxBrushVoxels);
  return {};
}

Done Viewer::State::run(const ShowLayer& show) {
  if (auto there = check_layer(show.layer); !there) return there;
  hidden.set(show.layer, !show.visible);
  dirty = true;
  return {};
}

Done Viewer::State::run(const ChangeLayer& change) {
  if (!settings) return protocol::fail(Code::bad_state, "layer: the map is not known yet", "layer");
  if (auto checked = protocol::check_layer_change(change.change, *settings); !checked)
    return checked;
  return session.change(change.change).map([](auto&&) {});
}

Done Viewer::State::run(const MoveCamera& move) {
  if (move.action != Action::fit)
    pilot.act(move);
  else if (settings)
    pilot.fit(*settings, meshes.chunks());
  return {};
}

Done Viewer::State::run(const StampHere&) {
  const auto [width, height] = pilot.camera().size();
  const auto at = pilot.camera().ground({width / 2, height / 2}, plane());
  if (!settings || !at)
    return protocol::fail(Code::bad_state, "stamp: there is no map in the middle of the picture");
  painter.begin(held.brush, *settings, *at, now);
  painter.end(now);
  return {};
}

Done Viewer::State::run(const Say& say) {
  if (session.say(protocol::Chat{.text = say.text, .id = kChatId})) return {};
  return protocol::fail(Code::unavailable, "text: not said, there is no connection now", "text");
}

Done Viewer::State::run(const Follow& follow) {
  const std::string who = follow.session.value_or("");
  const People::Person* person = people.find(who);
  if (!who.empty() && (!person || people.is_me(who)))
    return protocol::fail(Code::bad_field, "session: nobody else of that session is here",
                          "session");
  pilot.follow(who);
  return {};
}

Done Viewer::State::run(const OpenMap& open) {
  painter.end(now);
  session.open(open.map, now);
  leave_map();
  return {};
}

Done Viewer::State::run(const BePerson& person) {
  painter.flush(now);
  session.be(person.name, person.color, now);
  return {};
}

Done Viewer::State::run(const RetryNow&) {
  session.retry(now);
  return {};
}

void Viewer::State::grow_brush(double voxels) {
  double& radius = held.brush.radius_voxels;
  radius = std::clamp(radius + voxels, 0.0, scene::kMaxBrushVoxels);
}

void Viewer::State::run(BrushKey key) {
  scene::BrushSettings& brush = held.brush;
  switch (key) {
    case BrushKey::fill:
      brush.fill = true;
      break;
    case BrushKey::empty:
      brush.fill = false;
      break;
    case BrushKey::swap_fill:
      brush.fill = !brush.fill;
      break;
    case BrushKey::circle:
      brush.stencil = protocol::StencilShape::circle;
      break;
    case BrushKey::square:
      brush.stencil = protocol::StencilShape::square;
      break;
    case BrushKey::smaller:
      return grow_brush(-1);
    case BrushKey::larger:
      return grow_brush(1);
    case BrushKey::much_smaller:
      return grow_brush(-5);
    case BrushKey::much_larger:
      return grow_brush(5);
    case BrushKey::next_snap:
      brush.snap = brush.snap == scene::Snap::none      ? scene::Snap::centres
                   : brush.snap == scene::Snap::centres ? scene::Snap::lines
                                                        : scene::Snap::none;
      break;
    case BrushKey::layer_down:
      if (brush.layer > 0) --brush.layer;
      break;
    case BrushKey::layer_up:
      if (check_layer(brush.layer + 1)) ++brush.layer;
      break;
  }
}

void Viewer::State::run(StrokeKey key) {
  if (key == StrokeKey::stamp) {
    static_cast<void>(run(StampHere{}));
    return;
  }
  hand.cancel();
  painter.cancel();
  if (!pilot.followed().empty()) pilot.follow({});
}

void Viewer::State::run(const Shortcut& shortcut) {
  if (const auto* brush = std::get_if<BrushKey>(&shortcut)) return run(*brush);
  if (const auto* stroke = std::get_if<StrokeKey>(&shortcut)) return run(*stroke);
  if (const auto* tool = std::get_if<Tool>(&shortcut))
    static_cast<void>(run(UseTool{*tool}));
  else
    static_cast<void>(run(MoveCamera{.action = std::get<Action>(shortcut), .place = {}}));
}

}  // namespace earthwork::viewer
