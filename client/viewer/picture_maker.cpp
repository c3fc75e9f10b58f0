#include "client/viewer/picture_maker.hpp"

#include <utility>

namespace earthwork::viewer {

using protocol::MapPoint;

namespace {

constexpr const char* kFills = "#ffffff";
constexpr const char* kEmpties = "#ff6b4a";
constexpr const char* kShade = "#101418";
constexpr float kShadeOpacity = 0.55F, kBorderOpacity = 0.5F;
// CSS pixels.
constexpr double kBrushWidth = 2, kShadeWidth = 4.5, kCursorWidth = 2, kBorderWidth = 1.5;
constexpr double kCrossPixels = 7;
constexpr double kTolerancePixels = 0.2;

/// One line that crosses itself in the middle.
Outline cross(MapPoint at, double reach) {
  Outline out;
  out.closed = false;
  out.points = {
      {at.x - reach, at.y}, {at.x + reach, at.y}, at, {at.x, at.y + reach}, {at.x, at.y - reach}};
  return out;
}

double pixels(const Picture& picture, double count) { return count / picture.camera.place().zoom; }

/// The edge of a stamp there; of one so small that it has none, or of no brush, a cross.
Outline mark(const Picture& picture, const std::optional<protocol::Brush>& brush, MapPoint at) {
  Outline out;
  if (brush)
    out.points =
        scene::outline(brush->stencil, brush->radius, at, pixels(picture, kTolerancePixels));
  if (out.points.empty()) out = cross(at, pixels(picture, kCrossPixels));
  out.height = height_of(brush ? brush->layer : 0, picture.settings);
  return out;
}

void add(Picture& picture, Outline outline, Color color, double width) {
  outline.color = color;
  outline.width = width;
  picture.outlines.push_back(std::move(outline));
}

}  // namespace

double height_of(std::uint32_t layer, const protocol::MapSettings& settings) {
  return layer < settings.layers.size() ? settings.layers[layer].top : 0;
}

void add_border(Picture& picture) {
  if (!picture.settings.chunks) return;
  const double side = picture.settings.chunk_resolution * picture.settings.voxel_size;
  const auto& c = *picture.settings.chunks;
  const double x0 = c[0] * side, y0 = c[1] * side, x1 = c[2] * side, y1 = c[3] * side;
  Outline border;
  border.points = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  add(picture, std::move(border), color_of(kShade, kBorderOpacity), kBorderWidth);
}

void add_own_brush(Picture& picture, const scene::BrushSettings& brush, MapPoint at) {
  const double voxel = picture.settings.voxel_size;
  const MapPoint centre = scene::snapped(at, scene::snap_of(brush), voxel);
  const protocol::Brush held{.stencil = brush.stencil,
                             .radius = brush.radius_voxels * voxel,
                             .fill = brush.fill,
                             .layer = brush.layer};
  const Outline edge = mark(picture, held, centre);
  add(picture, edge, color_of(kShade, kShadeOpacity), kShadeWidth);  // seen on any ground
  add(picture, edge, color_of(brush.fill ? kFills : kEmpties), kBrushWidth);
}

void add_cursors(Picture& picture, const People& people) {
  for (const auto& [session, person] : people.persons()) {
    if (!person.cursor || people.is_me(session)) continue;
    add(picture, mark(picture, person.brush, *person.cursor), color_of(person.user.color),
        kCursorWidth);
  }
}

}  // namespace earthwork::viewer
