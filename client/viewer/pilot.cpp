#include "client/viewer/pilot.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace earthwork::viewer {

using protocol::MapRect;
using protocol::MapSettings;
using scene::Camera;
using scene::ScreenPoint;

namespace {

// Of a map without bounds, in voxels from 0 either way: what is shown before anything is known, and
// what is looked at to find something.
constexpr double kShownVoxels = 80, kSearchedVoxels = 256;
// A map may go on and on.
constexpr int kRounds = 8;

constexpr double kPanPart = 0.125;  // of the screen
constexpr double kZoomStep = 1.25;
constexpr double kTurnStep = std::numbers::pi / 12, kTiltStep = std::numbers::pi / 24;

MapRect around_zero(double voxels, const MapSettings& settings) {
  const double reach = voxels * settings.voxel_size;
  return {-reach, -reach, reach, reach};
}

MapRect united(const MapRect& a, const MapRect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

std::optional<MapRect> bounds_of(const MapSettings& settings) {
  if (!settings.chunks) return std::nullopt;
  const double side = settings.chunk_resolution * settings.voxel_size;
  const auto& c = *settings.chunks;
  return MapRect{c[0] * side, c[1] * side, c[2] * side, c[3] * side};
}

}  // namespace

void Pilot::moved() {
  shown_.reset();
  rounds_ = 0;
  followed_.clear();
}

void Pilot::resize(scene::ScreenSize size) {
  camera_.resize(size);
  if (shown_) camera_.fit(*shown_);
}

void Pilot::show(const MapRect& rect) {
  shown_ = rect;
  camera_.fit(rect);
}

void Pilot::start(const MapSettings& settings, const std::optional<Camera::Place>& at) {
  camera_.set_voxel_size(settings.voxel_size);
  if (!at) return fit(settings, {});
  moved();
  camera_.set(*at);
}

void Pilot::fit(const MapSettings& settings, const scene::Scene::Chunks& chunks) {
  moved();
  if (const auto bounds = bounds_of(settings)) return show(*bounds);
  rounds_ = kRounds;
  found_ = extent_of(chunks, settings);
  show(found_.value_or(around_zero(kShownVoxels, settings)));
}

// What was found only grows: of a map that is larger than a view may be, each view has another
// part.
void Pilot::caught_up(const MapSettings& settings, const scene::Scene::Chunks& chunks) {
  if (rounds_ == 0) return;
  --rounds_;
  const auto there = extent_of(chunks, settings);
  const auto all = there && found_ ? united(*there, *found_) : there;
  if (!all || all == found_) {
    rounds_ = 0;
    return;
  }
  found_ = all;
  show(*all);
}

void Pilot::act(const MoveCamera& move) {
  using Action = MoveCamera::Action;
  const scene::ScreenSize size = camera_.size();
  const ScreenPoint middle{size.width / 2, size.height / 2};
  const auto pan = [&](double x, double y) {
    camera_.pan(middle,
                {middle.x - x * kPanPart * size.width, middle.y - y * kPanPart * size.height});
  };
  switch (move.action) {
    case Action::fit:
      return;
    case Action::top:
      camera_.look_down();
      break;
    case Action::in:
      camera_.zoom_at(middle, kZoomStep);
      break;
    case Action::out:
      camera_.zoom_at(middle, 1 / kZoomStep);
      break;
    case Action::left:
      pan(-1, 0);
      break;
    case Action::right:
      pan(1, 0);
      break;
    case Action::up:
      pan(0, -1);
      break;
    case Action::down:
      pan(0, 1);
      break;
    case Action::turn_left:
      camera_.orbit(kTurnStep, 0);
      break;
    case Action::turn_right:
      camera_.orbit(-kTurnStep, 0);
      break;
    case Action::tilt_up:
      camera_.orbit(0, kTiltStep);
      break;
    case Action::tilt_down:
      camera_.orbit(0, -kTiltStep);
      break;
    case Action::go:
      camera_.set(move.place);
      break;
  }
  moved();
}

void Pilot::follow(std::string session) {
  moved();
  followed_ = std::move(session);
}

void Pilot::lead(const MapRect& view) {
  if (shown_ != view) show(view);
}

MapRect Pilot::wanted(const MapSettings& settings) const {
  double bottom = 0, top = 0;
  for (const auto& layer : settings.layers) {
    bottom = std::min(bottom, layer.bottom);
    top = std::max(top, layer.top);
  }
  const MapRect seen = camera_.seen(bottom, top);
  const bool searching = rounds_ > 0 && !found_;
  return searching ? united(seen, around_zero(kSearchedVoxels, settings)) : seen;
}

std::optional<MapRect> extent_of(const scene::Scene::Chunks& chunks, const MapSettings& settings) {
  constexpr double kSteps = 32768;  // of a mesh's coordinates, to a voxel
  std::optional<MapRect> all;
  for (const auto& [key, chunk] : chunks) {
    const auto at = [&](std::int32_t place, std::int32_t within) {
      return (1.0 * settings.chunk_resolution * place + within / kSteps) * settings.voxel_size;
    };
    for (const auto& vertex : chunk.mesh.vertices) {
      const double x = at(key.x, vertex.x), y = at(key.y, vertex.y);
      all = all ? united(*all, {x, y, x, y}) : MapRect{x, y, x, y};
    }
  }
  return all;
}

}  // namespace earthwork::viewer
