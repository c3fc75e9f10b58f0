#include "server/history/fold.hpp"

namespace earthwork::history {
namespace {

voxel::Grid grid_of(const protocol::MapSettings& settings) {
  voxel::Grid grid{.resolution = settings.chunk_resolution,
                   .voxel_size = settings.voxel_size,
                   .layers = static_cast<int>(settings.layers.size()),
                   .bounds = {}};
  if (settings.chunks) {
    const auto& c = *settings.chunks;
    grid.bounds = voxel::ChunkRect{c[0], c[1], c[2], c[3]};
  }
  return grid;
}

voxel::Shape shape_of(protocol::StencilShape stencil) {
  return stencil == protocol::StencilShape::square ? voxel::Shape::square : voxel::Shape::circle;
}

}  // namespace

voxel::Map make_map(const protocol::MapSettings& settings) { return voxel::Map(grid_of(settings)); }

std::vector<voxel::Stencil> stencils(const protocol::Edit& edit) {
  std::vector<voxel::Stencil> stamps;
  stamps.reserve(edit.path.size());
  for (const protocol::MapPoint& p : edit.path) {
    stamps.push_back({.x = p.x,
                      .y = p.y,
                      .radius = edit.radius,
                      .shape = shape_of(edit.stencil),
                      .fill = edit.fill ? voxel::Fill::filled : voxel::Fill::empty});
  }
  return stamps;
}

const voxel::Change& apply(voxel::Map& map, const protocol::Edit& edit) {
  return map.apply(static_cast<int>(edit.layer), stencils(edit));
}

const voxel::Change& apply(voxel::Map& map, const protocol::Action& action) {
  static const voxel::Change kNone;
  if (const auto* edit = std::get_if<protocol::Edit>(&action)) return apply(map, *edit);
  if (!std::get<protocol::LayerChange>(action).layer) map.set_layers(map.grid().layers + 1);
  return kNone;
}

}  // namespace earthwork::history
