#include "client/viewer/render/projection.hpp"

#include <algorithm>
#include <cmath>

namespace earthwork::viewer::render {
namespace {

int pixels(double size, double ratio) {
  return std::max(1, static_cast<int>(std::lround(size * ratio)));
}

}  // namespace

Projection projection_of(const Picture& picture) {
  const protocol::MapPoint& target = picture.camera.place().target;
  const double s = picture.settings.voxel_size;
  Projection out;
  out.voxel_size = s;
  out.origin_x = std::round(target.x / s);
  out.origin_y = std::round(target.y / s);
  out.width = pixels(picture.camera.size().width, picture.pixel_ratio);
  out.height = pixels(picture.camera.size().height, picture.pixel_ratio);
  out.pixel_ratio = picture.pixel_ratio;

  scene::Mat4 relative_from_voxels;
  relative_from_voxels.m = {
      s, 0, 0, 0, 0, s, 0, 0, 0, 0, 1, 0, out.origin_x * s - target.x, out.origin_y * s - target.y,
      0, 1};
  const scene::Mat4 clip = picture.camera.clip_from_relative() * relative_from_voxels;
  std::transform(clip.m.begin(), clip.m.end(), out.clip_from_voxels.begin(),
                 [](double value) { return static_cast<float>(value); });
  return out;
}

}  // namespace earthwork::viewer::render
